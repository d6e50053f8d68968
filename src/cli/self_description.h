#pragma once
// Man pages and shell completions, generated from the parser's options.

#include <string>

namespace CLI {
class App;
}

namespace echocine {

// roff: of the program, with all commands, or of one command.
std::string manPage(const CLI::App& program, const CLI::App* command = nullptr);

// Scripts that complete commands, options, the words of an option, and otherwise files.
std::string bashCompletion(const CLI::App& program);
std::string zshCompletion(const CLI::App& program);

// Writes all of them into an existing folder: echocine.1, echocine-COMMAND.1, echocine.bash,
// _echocine. Throws JobError.
void describeInto(const std::string& folder, const CLI::App& program);

}  // namespace echocine
