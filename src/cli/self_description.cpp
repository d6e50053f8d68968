#include "cli/self_description.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <functional>
#include <span>

#include "core/file.h"

namespace echocine {
namespace {

std::vector<const CLI::App*> commandsOf(const CLI::App& program) {
  return program.get_subcommands(std::function<bool(const CLI::App*)>());
}

// "-o", "--output"; nothing for what is found by its place.
std::vector<std::string> namesOf(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

bool isFlag(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

// The words that alone are accepted, as the check says them: "{segments,volumes}".
std::vector<std::string> wordsOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  std::vector<std::string> words;
  if (begin == std::string::npos || end == std::string::npos) return words;
  for (std::size_t at = begin + 1; at < end;) {
    const std::size_t comma = std::min(type.find(',', at), end);
    words.push_back(type.substr(at, comma - at));
    at = comma + 1;
  }
  return words;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

// roff takes a backslash as its own, a hyphen for a dash, and a point or quote that begins a line
// for a request.
std::string roff(const std::string& text) {
  std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  safe = replaced(safe, "\n", "\n.br\n");
  return safe.starts_with('.') || safe.starts_with('\'') ? "\\&" + safe : safe;
}

// Accepted values of an option: the second part of "INT:INT in [0 - 9]", after its kind.
std::string valueOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(type.find(':') + 1);
}

std::string optionEntry(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : namesOf(option))
    names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", roff(name));
  if (names.empty()) names = fmt::format("\\fI{}\\fR", roff(option.get_name()));
  if (!isFlag(option) && !namesOf(option).empty())
    names += fmt::format(" \\fI{}\\fR", roff(valueOf(option)));
  std::string meaning = roff(option.get_description()) + ".";
  if (!option.get_default_str().empty())
    meaning += fmt::format(" Default: {}.", roff(option.get_default_str()));
  if (option.get_required()) meaning += " Required.";
  return fmt::format(".TP\n{}\n{}\n", names, meaning);
}

std::string synopsisOf(const CLI::App& command) {
  std::string line = fmt::format("\\fBechocine {}\\fR", roff(command.get_name()));
  for (const CLI::Option* option : command.get_options())
    if (namesOf(*option).empty()) line += fmt::format(" \\fI{}\\fR", roff(option->get_name()));
  return line + " [\\fIoptions\\fR]\n";
}

std::string join(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + word;
  return line;
}

std::vector<std::string> optionNamesOf(const CLI::App& app) {
  std::vector<std::string> all;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : namesOf(*option)) all.push_back(name);
  return all;
}

// Within single quotes of a shell, and without what zsh reads in a description.
std::string quoted(const std::string& text) {
  std::string plain = text;
  for (const char* const special : {"[", "]", ":", "\n"}) plain = replaced(plain, special, " ");
  return replaced(plain, "'", "'\\''");
}

}  // namespace

std::string manPage(const CLI::App& program, const CLI::App* command) {
  const std::string title =
      command ? fmt::format("echocine-{}", command->get_name()) : std::string("echocine");
  const CLI::App& app = command ? *command : program;
  std::string page =
      fmt::format(".TH {} 1 \"\" \"echocine {}\"\n.SH NAME\n{} \\- {}\n", roff(title),
                  ECHOCINE_VERSION, roff(title), roff(app.get_description()));
  page += ".SH SYNOPSIS\n";
  if (command)
    page += synopsisOf(*command);
  else
    for (const CLI::App* one : commandsOf(program)) page += synopsisOf(*one) + ".br\n";
  page += ".SH OPTIONS\n";
  for (const CLI::Option* option : app.get_options()) page += optionEntry(*option);
  if (!command) {
    page += ".SH COMMANDS\n";
    for (const CLI::App* one : commandsOf(program))
      page +=
          fmt::format(".TP\n\\fB{}\\fR, see \\fBechocine\\-{}\\fR(1)\n{}\n", roff(one->get_name()),
                      roff(one->get_name()), roff(one->get_description()));
  }
  if (!app.get_footer().empty()) page += fmt::format(".SH NOTES\n{}\n", roff(app.get_footer()));
  return page +
         ".SH EXIT STATUS\n0 on success, 1 on a failed job, 2 on unusable arguments, scene "
         "or meshes.\n";
}

std::string bashCompletion(const CLI::App& program) {
  std::vector<std::string> commands;
  std::string cases, values;
  for (const CLI::App* command : commandsOf(program)) {
    commands.push_back(command->get_name());
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(),
                         join(optionNamesOf(*command)));
    for (const CLI::Option* option : command->get_options())
      if (const auto words = wordsOf(*option); !words.empty())
        for (const std::string& name : namesOf(*option))
          values +=
              fmt::format("    {}:{}) words=\"{}\" ;;\n", command->get_name(), name, join(words));
  }
  return fmt::format(R"(# bash completion of echocine
_echocine() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} words=""
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "{} {}" -- "$word"))
    return
  fi
  case "${{COMP_WORDS[1]}}:$before" in
{}  esac
  if [ -n "$words" ]; then
    COMPREPLY=($(compgen -W "$words" -- "$word"))
    return
  fi
  case "$word" in -*) ;; *) COMPREPLY=($(compgen -f -- "$word")); return ;; esac
  case "${{COMP_WORDS[1]}}" in
{}  esac
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -o filenames -F _echocine echocine
)",
                     join(commands), join(optionNamesOf(program)),
                     values.empty() ? "    *) ;;\n" : values, cases);
}

std::string zshCompletion(const CLI::App& program) {
  std::string commands, cases;
  for (const CLI::App* command : commandsOf(program)) {
    commands +=
        fmt::format("    '{}:{}'\n", command->get_name(), quoted(command->get_description()));
    cases += fmt::format("    {})\n      _arguments \\\n", command->get_name());
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : namesOf(*option)) {
        const auto words = wordsOf(*option);
        const std::string value = isFlag(*option) ? ""
                                  : words.empty() ? ":value:_files"
                                                  : fmt::format(":value:({})", join(words));
        cases +=
            fmt::format("        '{}[{}]{}' \\\n", name, quoted(option->get_description()), value);
      }
    cases += "        '*:file:_files' ;;\n";
  }
  return fmt::format(R"(#compdef echocine
_echocine() {{
  local -a commands
  commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    compadd -- {}
    return
  fi
  case "$words[2]" in
{}  esac
}}
_echocine "$@"
)",
                     commands, join(optionNamesOf(program)), cases);
}

void describeInto(const std::string& folder, const CLI::App& program) {
  const auto write = [&](const std::string& name, const std::string& text) {
    writeFileWhole(std::filesystem::path(folder) / name, std::as_bytes(std::span(text)));
  };
  write("echocine.1", manPage(program));
  for (const CLI::App* command : commandsOf(program))
    write(fmt::format("echocine-{}.1", command->get_name()), manPage(program, command));
  write("echocine.bash", bashCompletion(program));
  write("_echocine", zshCompletion(program));
}

}  // namespace echocine
