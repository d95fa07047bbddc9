#include "server/replay/subcommand_options.hpp"

#include <CLI/CLI.hpp>
#include <utility>

#include "common/os/output_file.hpp"
#include "server/store/place_rule.hpp"

namespace runstone {
namespace {

void set_presence(CLI::Option* option, const std::string& name,
                  SubcommandOptions::Presence presence) {
  const bool is_positional = !name.starts_with('-');
  using Presence = SubcommandOptions::Presence;
  if (presence == Presence::required || (is_positional && presence == Presence::optional))
    option->required();
}

}  // namespace

void SubcommandOptions::common(CommonOptions& out, const std::string& world_help) {
  place("--world", out.world, world_help, Presence::required);
  output_file("--json", out.json, "write the report as JSON to this file");
  flag("--progress", out.progress, "print progress even if standard error is no terminal");
}

void SubcommandOptions::flag(const std::string& name, bool& out, const std::string& help) {
  app_.add_flag(name, out, help);
}

void SubcommandOptions::text(const std::string& name, std::string& out, const std::string& help,
                             Presence presence) {
  set_presence(app_.add_option(name, out, help), name, presence);
}

void SubcommandOptions::place(const std::string& name, std::string& out, const std::string& help,
                              Presence presence) {
  CLI::Option* option = app_.add_option(name, out, help);
  option->check(place_refusal);
  set_presence(option, name, presence);
}

void SubcommandOptions::folder(const std::string& name, std::string& out, const std::string& help) {
  CLI::Option* option = app_.add_option(name, out, help);
  option->check(folder_refusal);
  set_presence(option, name, Presence::optional);
}

void SubcommandOptions::existing_file(const std::string& name, std::string& out,
                                      const std::string& help) {
  CLI::Option* option = app_.add_option(name, out, help);
  option->check(CLI::ExistingFile);
  set_presence(option, name, Presence::optional);
}

void SubcommandOptions::output_file(const std::string& name, std::string& out,
                                    const std::string& help, Presence presence) {
  CLI::Option* option = app_.add_option(name, out, help);
  option->check(output_refusal);
  set_presence(option, name, presence);
}

void SubcommandOptions::texts(const std::string& name, std::vector<std::string>& out,
                              const std::string& help) {
  app_.add_option(name, out, help);
}

void SubcommandOptions::number(const std::string& name, std::uint64_t& out, std::uint64_t min,
                               std::uint64_t max, const std::string& help) {
  app_.add_option(name, out, help)->check(CLI::Range(min, max));
}

void SubcommandOptions::parsed(const std::string& name, Parser parser, const std::string& help,
                               Presence presence) {
  const auto take = [name, parse = std::move(parser)](const std::string& text) {
    if (const std::string wrong = parse(text); !wrong.empty()) {
      throw CLI::ValidationError(name, wrong);
    }
  };
  set_presence(app_.add_option_function<std::string>(name, take, help), name, presence);
}

void SubcommandOptions::moment(const std::string& name, std::optional<NamedMoment>& out,
                               const std::string& help, Presence presence) {
  const auto parse = [&out](const std::string& text) -> std::string {
    const auto moment = parse_moment(text);
    if (!moment) return moment.error();
    out = *moment;
    return {};
  };
  parsed(name, parse,
         help +
             ": a sequence number, a time (2026-11-21T23:05:00Z), "
             "or a time before the last edit (-2h30m)",
         presence);
}

}  // namespace runstone
