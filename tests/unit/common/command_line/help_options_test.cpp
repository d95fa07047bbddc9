#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "common/command_line/help_options.hpp"

namespace runstone {
namespace {

/// A command line of each kind of option and of two levels of subcommands.
struct SampleProgram {
  std::string text, kind, file, axis;
  bool flag = false;
  CLI::App app{"Sample of a program.", "sample"};

  SampleProgram() {
    app.set_version_flag("--version", "sample 1");
    add_help_options(app, "sample-program",
                     [] { return std::vector{CommandHelp{"key", "moves a key", "", {}, {}}}; });
    app.add_option("-w,--world", text, "folder [of the world]: it's a \\ path")->required();
    app.add_flag("--create", flag, ".begins with a dot");
    app.add_option("--kept", text, "days")->group("Settings");
    CLI::App* const made = app.add_subcommand("import", "make a world");
    made->add_option("KIND", kind, "what it is")->required()->option_text("luanti|file");
    made->add_option("--schem", file, "version")->check(CLI::IsMember({"2", "3"}));
    made->add_option("--up", axis, "axis")
        ->transform(CLI::Transformer(std::map<std::string, std::string>{{"y", "0"}, {"z", "1"}}));
    CLI::App* const deep = made->add_subcommand("deep", "the second level");
    deep->add_flag("--wide", flag, "wide");
    deep->add_option("PLACE", file, "where it is");
  }

  /// Returns what the program prints with these arguments, and requires the exit code 0.
  std::string printed(const std::vector<std::string>& arguments) {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    std::ostringstream out, err;
    try {
      app.parse(reversed);
    } catch (const CLI::ParseError& error) {
      REQUIRE(app.exit(error, out, err) == 0);
      return out.str();
    }
    FAIL("the option printed nothing");
    return {};
  }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Returns the words of `--help` that begin an entry with dashes: an oracle that knows no CLI::App.
std::set<std::string> help_names(const std::string& help) {
  std::set<std::string> out;
  const std::regex entry("\n  ((?:-[a-z],)?--[a-z-]+|-[a-z](?= ))");
  for (std::sregex_iterator at(help.begin(), help.end(), entry), end; at != end; ++at) {
    std::istringstream names((*at)[1].str());
    for (std::string name; std::getline(names, name, ',');) out.insert(name);
  }
  return out;
}

std::string as_roff(const std::string& name) {
  return std::regex_replace(name, std::regex("-"), "\\-");
}

}  // namespace

TEST_CASE("each option of a program's help is in its man page and in its completions") {
  for (const std::string subcommand : {"", "import"}) {
    CAPTURE(subcommand);
    std::vector<std::string> words;
    if (!subcommand.empty()) words.push_back(subcommand);
    words.push_back("--help");
    const auto names = help_names(SampleProgram().printed(words));
    CHECK(names.count("--help") == 1);
    CHECK(names.count(subcommand.empty() ? "--world" : "--schem") == 1);
    const std::string man = SampleProgram().printed({"--help-man"});
    const std::string bash = SampleProgram().printed({"--completion", "bash"});
    const std::string zsh = SampleProgram().printed({"--completion", "zsh"});
    const std::string fish = SampleProgram().printed({"--completion", "fish"});
    for (const std::string& name : names) {
      CAPTURE(name);
      CHECK(contains(man, "\\fB" + as_roff(name) + "\\fR"));
      CHECK(contains(bash, " " + name));
      CHECK(contains(zsh, "'" + name + "["));
      CHECK(contains(fish, name.starts_with("--") ? " -l " + name.substr(2) + " "
                                                  : " -s " + name.substr(1) + " "));
    }
  }
}

TEST_CASE("hidden options are in no help, man page or completion") {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--help"},
                                                {"--help-man"},
                                                {"--completion", "bash"},
                                                {"--completion=zsh"},
                                                {"--completion", "fish"}}) {
    const std::string text = SampleProgram().printed(words);
    CAPTURE(words, text);
    CHECK_FALSE(contains(text, "help-man"));
    CHECK_FALSE(contains(text, "help\\-man"));
    CHECK_FALSE(std::regex_search(text, std::regex("--?l? ?completion")));
  }
}

TEST_CASE("a man page keeps characters that mean something to roff") {
  const std::string man = SampleProgram().printed({"--help-man"});
  CHECK(man.starts_with(".TH \"SAMPLE\\-PROGRAM\" 1 \"\" \"Runstone "));
  CHECK(contains(man, "sample\\-program \\- Sample of a program\n"));
  CHECK(contains(man, "\nfolder [of the world]: it's a \\e path\nThis is required.\n"));
  CHECK(contains(man, "\n\\&.begins with a dot\n"));
  CHECK(contains(man, ".SH SETTINGS\n.TP\n\\fB\\-\\-kept\\fR"));
  CHECK(contains(
      man, ".SS \"\\fBimport\\fR [\\fIOPTIONS\\fR] \\fIKIND\\fR [\\fISUBCOMMAND\\fR ...]\"\n"));
  CHECK(contains(man, ".SS \"\\fBimport deep\\fR"));
  CHECK(contains(man, "\n.TP\n\\fIKIND\\fR \\fIluanti|file\\fR\nwhat it is\n"));
  CHECK(contains(man, "\n.TP\n\\fIPLACE\\fR\nwhere it is\n"));
  CHECK(contains(man, ".SS \"\\fBkey\\fR"));
}

TEST_CASE("completions offer the values that an option lists") {
  const std::string bash = SampleProgram().printed({"--completion", "bash"});
  CHECK(contains(bash, "'/import --schem') COMPREPLY=($(compgen -W '2 3'"));
  CHECK(contains(bash, "'/import --up') COMPREPLY=($(compgen -W 'y z'"));
  CHECK(contains(bash, "'/import') words='deep "));
  CHECK(contains(bash, " luanti file"));
  CHECK(contains(bash, "' -w'|' --world'|' --kept') return ;;"));
  CHECK_FALSE(contains(bash, "' --create'"));
  // The value of an option is no subcommand.
  CHECK(contains(bash, "'/import --schem'|'/import --up') continue ;;"));
  CHECK(contains(bash, "/import|/import/deep|/key)"));
  const std::string zsh = SampleProgram().printed({"--completion", "zsh"});
  CHECK(zsh.starts_with("#compdef sample-program\n"));
  CHECK(contains(zsh, "'--schem[version]:value:(2 3)'"));
  CHECK(contains(zsh, "':KIND:(luanti file)'"));
  CHECK(contains(zsh, "'--world[folder \\[of the world\\]: it'\\''s a \\\\ path]:value:_files'"));
  const std::string fish = SampleProgram().printed({"--completion", "fish"});
  CHECK(contains(fish,
                 "-n '__fish_seen_subcommand_from import; and not __fish_seen_subcommand_from deep'"
                 " -l schem -x -a '2 3' -d 'version'\n"));
  CHECK(contains(fish,
                 " -n 'not __fish_seen_subcommand_from import key' -s w -l world -r -F -d "
                 "'folder [of the world]: it\\'s a \\\\ path'\n"));
}

TEST_CASE("an unknown shell is refused with the names of the known ones") {
  SampleProgram sample;
  std::ostringstream out, err;
  try {
    sample.app.parse(std::vector<std::string>{"tcsh", "--completion"});
    FAIL("the shell was accepted");
  } catch (const CLI::ParseError& error) {
    CHECK(sample.app.exit(error, out, err) != 0);
  }
  CHECK(contains(err.str(), "bash, zsh or fish"));
  CHECK(is_help_option("--help-man"));
  CHECK(is_help_option("--completion=bash"));
  CHECK_FALSE(is_help_option("--help"));
}

}  // namespace runstone
