#include "tests/bench/report/report_options.hpp"

#include <CLI/CLI.hpp>
#include <set>

#include "tests/bench/report/step.hpp"

namespace runstone::bench {

CLI::App* add_report_command(CLI::App& app, ReportOptions& options) {
  options.thesis = RUNSTONE_SOURCE_DIR "/tests/data/thesis";
  std::set<std::string> steps;
  for (const Step& step : report_steps(options)) steps.insert(step.name);
  CLI::App* report = app.add_subcommand(
      "report", "measures everything and makes a page of it: tables, figures, verdicts");
  report
      ->add_option(
          "--out", options.out,
          "folder of the page (index.html), its tables (csv/) and what was measured (data/)")
      ->required();
  report->add_flag("--quick", options.is_quick,
                   "everything, but few repetitions: some five minutes");
  report->add_option("--steps", options.steps, "what to measure; all by default")
      ->delimiter(',')
      ->check(CLI::IsMember(steps));
  report->add_flag("--again", options.is_again,
                   "measure everything again; otherwise a run continues where it was interrupted");
  report->add_flag("--page-only", options.is_page_only,
                   "measure nothing: make the page from the existing results");
  report->add_option("--luanti", options.luanti, "folder of a Luanti world")
      ->capture_default_str()
      ->check(CLI::ExistingDirectory);
  report->add_option("--thesis", options.thesis, "folder of the thesis' tables")
      ->capture_default_str();
  return report;
}

}  // namespace runstone::bench
