#pragma once
// Man pages and completions of shells, made from what the parser knows: no second list of options.

#include <string>

namespace CLI {
class App;
}

namespace echocine {

// roff: of the program, which names every command, or of one of its commands.
std::string manPage(const CLI::App& program, const CLI::App* command = nullptr);

// Scripts that complete commands, their options and the words that an option takes, and else files.
std::string bashCompletion(const CLI::App& program);
std::string zshCompletion(const CLI::App& program);

// Writes all of them into an existing folder: echocine.1, echocine-COMMAND.1, echocine.bash,
// _echocine. Throws JobError.
void describeInto(const std::string& folder, const CLI::App& program);

}  // namespace echocine
