#include "server/web/web_options.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <string>

#include "common/command_line/help_options.hpp"
#include "common/os/output_file.hpp"
#include "protocol/program_version.hpp"
#include "server/web/web_config.hpp"

namespace runstone {

ParsedWebOptions parse_web_options(int argc, const char* const* argv) {
  WebOptions out;
  CLI::App app{"Runstone gateway for browsers"};
  // The last value wins, so that arguments appended to a fixed command line (a container's) change
  // it.
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  app.set_version_flag("--version", program_version("runstone-web"));
  add_help_options(app, "runstone-web");
  app.add_option("--config", out.config_file,
                 "TOML file of settings; environment and flags win over it");
  app.add_flag("--print-config", out.print_config, "print all settings as TOML and exit");
  app.add_option("--port-file", out.port_file, "write the port here once the gateway listens")
      ->check(output_refusal);
  add_setting_flags(app, web_settings().fields(), out.settings);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ExtrasError&) {
    const std::string argument = app.remaining(true).front();
    std::cerr << "runstone-web: \"" << argument << "\" is no flag" << nearest_flag(app, argument)
              << "; --help lists the flags\n";
    return {std::nullopt, 2};
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error) == 0 ? 0 : 2};
  }
  return {out, 0};
}

}  // namespace runstone
