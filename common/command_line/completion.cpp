#include "common/command_line/completion.hpp"

#include <vector>

namespace runstone {
namespace {

/// Returns `text` in single quotes, as bash and zsh read them.
std::string shell_quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      out += c == '\n' ? ' ' : c;
    }
  }
  return out + "'";
}

std::string fish_quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + "'";
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

/// Returns the name of a program as that of a function of a shell: "_runstone_server".
std::string shell_function(std::string_view program) {
  std::string out = "_";
  for (const char c : program) out += c == '-' ? '_' : c;
  return out;
}

/// A subcommand for which bash completes words. `path` is "/import" for `import`, and "" for the
/// program itself.
struct BashNode {
  std::string path;
  const CommandHelp* command;
};

void append_bash_nodes(const CommandHelp& command, const std::string& path,
                       std::vector<BashNode>& out) {
  out.push_back({path, &command});
  for (const CommandHelp& subcommand : command.subcommands)
    append_bash_nodes(subcommand, path + "/" + subcommand.name, out);
}

std::string bash_script(const CommandHelp& program) {
  std::vector<BashNode> nodes;
  append_bash_nodes(program, "", nodes);
  std::string paths, values, words, options_with_value;
  for (const auto& [path, command] : nodes) {
    if (!path.empty()) paths += (paths.empty() ? "" : "|") + path;
    std::vector<std::string> offered, files;
    for (const CommandHelp& subcommand : command->subcommands) offered.push_back(subcommand.name);
    for (const OptionHelp& option : command->options) {
      if (option.is_positional) {
        offered.insert(offered.end(), option.choices.begin(), option.choices.end());
        continue;
      }
      offered.insert(offered.end(), option.names.begin(), option.names.end());
      if (option.value.empty() || option.is_value_optional) continue;
      std::string pattern;
      for (const std::string& name : option.names)
        pattern += (pattern.empty() ? "'" : "|'") + path + " " + name + "'";
      options_with_value += (options_with_value.empty() ? "" : "|") + pattern;
      if (option.choices.empty()) {
        files.push_back(pattern);
      } else {
        values += "    " + pattern + ") COMPREPLY=($(compgen -W " +
                  shell_quoted(joined(option.choices)) + " -- \"$word\")); return ;;\n";
      }
    }
    // An empty reply lets bash complete names of files.
    std::string pattern;
    for (const std::string& file : files) pattern += (pattern.empty() ? "" : "|") + file;
    if (!pattern.empty()) values += "    " + pattern + ") return ;;\n";
    words += "    '" + path + "') words=" + shell_quoted(joined(offered)) + " ;;\n";
  }
  const std::string function = shell_function(program.name);
  std::string out = "# bash completion for " + program.name + "\n" + function + "() {\n" +
                    "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
                    "  local path= words= i option=\n  COMPREPLY=()\n"
                    // Bash makes three words of `--option=value`.
                    "  if [[ $word == = ]]; then word=; fi\n"
                    "  if [[ $before == = ]]; then before=${COMP_WORDS[COMP_CWORD-2]}; fi\n";
  if (!paths.empty()) {
    out += "  for ((i = 1; i < COMP_CWORD; ++i)); do\n";
    if (!options_with_value.empty()) {
      // The value of an option is no subcommand.
      out +=
          "    option=${COMP_WORDS[i-1]}\n"
          "    if [[ $option == = ]]; then option=${COMP_WORDS[i-2]}; fi\n"
          "    case \"$path $option\" in\n      " +
          options_with_value + ") continue ;;\n    esac\n";
    }
    out += "    case \"$path/${COMP_WORDS[i]}\" in\n      " + paths +
           ") path=$path/${COMP_WORDS[i]} ;;\n    esac\n  done\n";
  }
  if (!values.empty()) out += "  case \"$path $before\" in\n" + values + "  esac\n";
  out += "  case \"$path\" in\n" + words +
         "  esac\n  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n}\n"
         "complete -o bashdefault -o default -F " +
         function + " " + program.name + "\n";
  return out;
}

/// Returns a text for a place in an argument of _arguments that ends with one of `ends`.
std::string zsh_escaped(std::string_view text, std::string_view ends) {
  std::string out;
  for (const char c : text) {
    if (c == '\\' || ends.find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

/// Returns what _arguments completes as the value of an option.
std::string zsh_value(const OptionHelp& option) {
  const std::string name =
      zsh_escaped(option.is_positional ? option.names.front() : std::string("value"), ":");
  return ":" + name + ":" +
         (option.choices.empty() ? "_files" : "(" + joined(option.choices) + ")");
}

void append_zsh_functions(const CommandHelp& command, const std::string& function,
                          std::string& out) {
  for (const CommandHelp& subcommand : command.subcommands)
    append_zsh_functions(subcommand, function + "__" + subcommand.name, out);
  const bool has_subcommands = !command.subcommands.empty();
  out += function + "() {\n";
  if (has_subcommands) out += "  local curcontext=$curcontext state line\n  typeset -A opt_args\n";
  out += has_subcommands ? "  _arguments -C" : "  _arguments";
  for (const OptionHelp& option : command.options) {
    if (option.is_positional) {
      out += " \\\n    " + shell_quoted(zsh_value(option));
      continue;
    }
    for (const std::string& name : option.names) {
      std::string spec = name + "[" + zsh_escaped(option.help, "[]") + "]";
      if (!option.value.empty() && !option.is_value_optional) spec += zsh_value(option);
      out += " \\\n    " + shell_quoted(spec);
    }
  }
  if (has_subcommands) {
    out +=
        " \\\n    '1:subcommand:->subcommand' '*::argument:->argument'\n  case $state in\n"
        "    subcommand)\n      local -a subcommands=(\n";
    for (const CommandHelp& subcommand : command.subcommands) {
      out += "        " +
             shell_quoted(subcommand.name + ":" + zsh_escaped(subcommand.description, "")) + "\n";
    }
    out +=
        "      )\n      _describe subcommand subcommands ;;\n    argument)\n"
        "      case $words[1] in\n";
    for (const CommandHelp& subcommand : command.subcommands)
      out += "        " + subcommand.name + ") " + function + "__" + subcommand.name + " ;;\n";
    out += "      esac ;;\n  esac";
  }
  out += "\n}\n";
}

std::string zsh_script(const CommandHelp& program) {
  const std::string function = shell_function(program.name);
  std::string out = "#compdef " + program.name + "\n";
  append_zsh_functions(program, function, out);
  // The file is the body of the function that zsh loads by its name, so it ends with a call.
  return out + function + " \"$@\"\n";
}

void append_fish_lines(const std::string& program, const CommandHelp& command,
                       const std::vector<std::string>& above, std::string& out) {
  std::string condition;
  for (const std::string& name : above)
    condition += (condition.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + name);
  std::vector<std::string> below;
  for (const CommandHelp& subcommand : command.subcommands) below.push_back(subcommand.name);
  if (!below.empty()) {
    condition += (condition.empty() ? "not " : "; and not ") +
                 ("__fish_seen_subcommand_from " + joined(below));
  }
  const std::string begin =
      "complete -c " + program + (condition.empty() ? "" : " -n " + fish_quoted(condition));
  for (const CommandHelp& subcommand : command.subcommands) {
    out +=
        begin + " -f -a " + subcommand.name + " -d " + fish_quoted(subcommand.description) + "\n";
  }
  for (const OptionHelp& option : command.options) {
    const std::string end = " -d " + fish_quoted(option.help) + "\n";
    if (option.is_positional) {
      if (!option.choices.empty())
        out += begin + " -a " + fish_quoted(joined(option.choices)) + end;
      continue;
    }
    std::string names;
    for (const std::string& name : option.names)
      names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    std::string value;
    if (!option.value.empty() && !option.is_value_optional) {
      value = option.choices.empty() ? " -r -F" : " -x -a " + fish_quoted(joined(option.choices));
    }
    out += begin + names + value + end;
  }
  for (const CommandHelp& subcommand : command.subcommands) {
    std::vector<std::string> path = above;
    path.push_back(subcommand.name);
    append_fish_lines(program, subcommand, path, out);
  }
}

}  // namespace

std::optional<CompletionShell> parse_completion_shell(std::string_view text) {
  if (text == "bash") return CompletionShell::bash;
  if (text == "zsh") return CompletionShell::zsh;
  if (text == "fish") return CompletionShell::fish;
  return std::nullopt;
}

std::string completion_script(const CommandHelp& program, CompletionShell shell) {
  switch (shell) {
    case CompletionShell::bash:
      return bash_script(program);
    case CompletionShell::zsh:
      return zsh_script(program);
    case CompletionShell::fish:
      break;
  }
  std::string out = "# fish completion for " + program.name + "\n";
  append_fish_lines(program.name, program, {}, out);
  return out;
}

}  // namespace runstone
