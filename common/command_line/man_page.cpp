#include "common/command_line/man_page.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace runstone {
namespace {

/// Returns `text` so that roff prints it as it is. A dash is a minus sign, which can be searched and
/// copied.
std::string roff(std::string_view text) {
  std::string out;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) out += "\\&";
    begins_line = c == '\n';
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

std::string bold(std::string_view text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + roff(text) + "\\fR"; }

/// Returns a paragraph, which ends with a line break.
std::string paragraph(std::string_view text) { return roff(text) + "\n"; }

std::string option_entry(const OptionHelp& option) {
  std::string out = ".TP\n";
  for (std::size_t i = 0; i < option.names.size(); ++i) {
    if (i > 0) out += ", ";
    out += option.is_positional ? italic(option.names[i]) : bold(option.names[i]);
  }
  // The value of a positional argument is its type, which says nothing, unless it lists the choices.
  if (!option.value.empty() && (!option.is_positional || !option.choices.empty())) {
    out +=
        option.is_value_optional ? " [" + italic(option.value) + "]" : " " + italic(option.value);
  }
  out += "\n" + paragraph(option.help.empty() ? "(no description)" : option.help);
  if (option.is_required) out += "This is required.\n";
  return out;
}

/// Writes the options, group by group. `is_section` gives each group a section of its own.
std::string option_list(const CommandHelp& command, bool is_section) {
  std::vector<std::string> groups;
  for (const OptionHelp& option : command.options) {
    if (std::find(groups.begin(), groups.end(), option.group) == groups.end())
      groups.push_back(option.group);
  }
  std::string out;
  for (std::string group : groups) {
    std::string entries;
    for (const OptionHelp& option : command.options) {
      if (option.group == group) entries += option_entry(option);
    }
    if (is_section) {
      for (char& c : group) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      out += ".SH " + roff(group) + "\n";
    }
    out += entries;
  }
  return out;
}

std::string synopsis(const std::string& name, const CommandHelp& command) {
  std::string out = bold(name);
  if (!command.options.empty()) out += " [" + italic("OPTIONS") + "]";
  for (const OptionHelp& option : command.options) {
    if (!option.is_positional) continue;
    const std::string word = italic(option.names.front());
    out += option.is_required ? " " + word : " [" + word + "]";
  }
  if (!command.subcommands.empty()) out += " [" + italic("SUBCOMMAND") + " ...]";
  return out;
}

std::string subcommand_parts(const std::string& above, const CommandHelp& command) {
  std::string out;
  for (const CommandHelp& subcommand : command.subcommands) {
    const std::string name = above + subcommand.name;
    out += ".SS \"" + synopsis(name, subcommand) + "\"\n" + paragraph(subcommand.description) +
           option_list(subcommand, false);
    if (!subcommand.footer.empty()) out += ".PP\n" + paragraph(subcommand.footer);
    out += subcommand_parts(name + " ", subcommand);
  }
  return out;
}

}  // namespace

std::string man_page(const CommandHelp& program, const std::string& version) {
  std::string title = program.name;
  for (char& c : title) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string summary = program.description;
  if (summary.ends_with('.')) summary.pop_back();
  std::string out = ".TH \"" + roff(title) + "\" 1 \"\" \"Runstone " + roff(version) +
                    "\" \"User Commands\"\n.SH NAME\n" + roff(program.name) + " \\- " +
                    roff(summary) + "\n.SH SYNOPSIS\n" + synopsis(program.name, program) +
                    "\n.SH DESCRIPTION\n" + paragraph(program.description);
  if (!program.footer.empty()) out += ".PP\n" + paragraph(program.footer);
  out += option_list(program, true);
  if (!program.subcommands.empty()) out += ".SH SUBCOMMANDS\n" + subcommand_parts("", program);
  return out;
}

}  // namespace runstone
