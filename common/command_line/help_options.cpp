#include "common/command_line/help_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <utility>

#include "common/command_line/completion.hpp"
#include "common/command_line/man_page.hpp"
#include "common/core/version.hpp"

namespace runstone {
namespace {

constexpr std::string_view kManOption = "--help-man";
constexpr std::string_view kCompletionOption = "--completion";

std::vector<std::string> split_words(std::string_view text, char separator) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    if (end > 0) words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

/// Returns the values of an option that lists them: "luanti|minecraft" as its text, or "TEXT:{2,3}"
/// as its type, which CLI::IsMember makes.
std::vector<std::string> listed_choices(const std::string& text, const std::string& type) {
  if (text.find('|') != std::string::npos && text.find(' ') == std::string::npos)
    return split_words(text, '|');
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}', std::min(begin, type.size()));
  if (end == std::string::npos) return {};
  std::vector<std::string> out;
  for (const std::string& word :
       split_words(std::string_view(type).substr(begin + 1, end - begin - 1), ',')) {
    out.push_back(word.substr(0, word.find("->")));  // "y->0", which CLI::Transformer makes
  }
  return out;
}

OptionHelp option_help(const CLI::Option& option) {
  OptionHelp out;
  out.is_positional = option.get_positional() && !option.nonpositional();
  if (out.is_positional) {
    out.names.push_back(option.get_name(true));
  } else {
    for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
  }
  if (option.get_items_expected_max() > 0) {
    const std::string type = option.get_type_name();
    out.choices = listed_choices(option.get_option_text(), type);
    out.value = option.get_option_text().empty() ? type : option.get_option_text();
    if (out.value.empty()) out.value = "VALUE";
    out.is_value_optional = option.get_items_expected_min() == 0;
  }
  out.help = option.get_description();
  out.group = option.get_group();
  out.is_required = option.get_required();
  return out;
}

}  // namespace

CommandHelp command_help(const CLI::App& app, std::string name) {
  CommandHelp out{std::move(name), app.get_description(), app.get_footer(), {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_group().empty()) out.options.push_back(option_help(*option));
  }
  for (const CLI::App* subcommand : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!subcommand->get_group().empty())
      out.subcommands.push_back(command_help(*subcommand, subcommand->get_name()));
  }
  return out;
}

void add_help_options(CLI::App& app, const std::string& program, MoreSubcommands more) {
  const auto help = [&app, program, more = std::move(more)] {
    CommandHelp out = command_help(app, program);
    if (more) {
      for (CommandHelp& subcommand : more()) out.subcommands.push_back(std::move(subcommand));
    }
    return out;
  };
  // App::exit() prints the text of CallForVersion, with a line break behind it.
  const auto print = [](std::string text) {
    if (text.ends_with('\n')) text.pop_back();
    throw CLI::CallForVersion(std::move(text), 0);
  };
  app.add_flag_callback(
         std::string(kManOption),
         [help, print] { print(man_page(help(), std::string(version()))); },
         "print the man page of this program")
      ->group("");
  app.add_option_function<std::string>(
         std::string(kCompletionOption),
         [help, print](const std::string& shell) {
           print(completion_script(help(), *parse_completion_shell(shell)));
         },
         "print the completion for a shell: bash, zsh or fish")
      ->check([](const std::string& text) {
        return parse_completion_shell(text) ? std::string() : "a shell is bash, zsh or fish";
      })
      ->group("");
}

bool is_help_option(std::string_view word) {
  const std::string_view name = word.substr(0, word.find('='));
  return name == kManOption || name == kCompletionOption;
}

}  // namespace runstone
