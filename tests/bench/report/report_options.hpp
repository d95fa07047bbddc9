// ReportOptions: the command line of `runstone-bench report`.
#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace runstone::bench {

struct ReportOptions {
  std::string out;                 // folder of the page and of the findings
  std::string luanti;              // folder of the real world
  std::string thesis;              // folder of the thesis' tables
  std::vector<std::string> steps;  // to measure; empty: all
  bool is_quick = false;
  bool is_again = false;      // also measures steps that have a result
  bool is_page_only = false;  // measures nothing
};

/// Adds the subcommand. `options` must outlive the parse.
CLI::App* add_report_command(CLI::App& app, ReportOptions& options);

}  // namespace runstone::bench
