#include "tests/bench/report/report.hpp"

#include <fmt/chrono.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "tests/bench/harness/clocks.hpp"
#include "tests/bench/network/child.hpp"
#include "tests/bench/report/page.hpp"
#include "tests/bench/report/progress_bar.hpp"
#include "tests/bench/report/step.hpp"

namespace runstone::bench {
namespace {

std::string utc_now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

/// Returns the folder's name and the size of its content, which distinguishes worlds of one name.
std::string world_name(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path path = fs::weakly_canonical(folder, error);
  std::uintmax_t bytes = fs::file_size(path / "map.sqlite", error);
  if (error) bytes = 0;
  return fmt::format("{} of {} bytes", path.filename().string(), bytes);
}

/// Returns a finding of this run without a result.
Finding finding_of(const ReportOptions& options, const Step& step) {
  Finding out;
  out.step = step.name;
  out.machine = this_machine();
  out.is_quick = options.is_quick;
  out.luanti = world_name(options.luanti);
  return out;
}

/// Returns true if the folder has a comparable finding.
bool is_there(const ReportOptions& options, const Step& step) {
  const auto found = read_finding(options.out, step.name);
  // Two different trees with uncommitted changes have the same name.
  const std::string commit = this_machine().commit;
  if (commit.ends_with("-dirty") || commit == "unknown") return false;
  return found && is_comparable(*found, finding_of(options, step));
}

Result<double, std::string> measure(const ReportOptions& options, const Step& step,
                                    std::ostream& log) {
  fmt::print(log, "\n== {} ==\n", step.name);
  log.flush();
  const std::uint64_t start = now_ns();
  auto result = step.measure(log);
  const double seconds = static_cast<double>(now_ns() - start) * 1e-9;
  if (!result) return Unexpected<std::string>{result.error()};
  Finding finding = finding_of(options, step);
  finding.measured_at = utc_now();
  finding.seconds = seconds;
  finding.result = *std::move(result);
  if (const auto written = write_finding(options.out, finding); !written) {
    return Unexpected<std::string>{written.error()};
  }
  return seconds;
}

/// Returns the reason why this run must not begin; empty if it may.
std::string objection(const ReportOptions& options) {
  const std::vector<Step> steps = report_steps(options);
  for (const std::string& name : options.steps) {
    const auto is_it = [&](const Step& step) { return step.name == name; };
    if (std::none_of(steps.begin(), steps.end(), is_it)) return "a quick run has no step " + name;
  }
  if (!options.is_quick || options.is_again) return "";
  for (const Step& step : steps) {
    const auto found = read_finding(options.out, step.name);
    if (found && !found->is_quick) {
      return options.out +
             " has figures of a full run, which a quick one would replace: take another folder, "
             "or say --again";
    }
  }
  return "";
}

std::vector<Step> wanted_steps(const ReportOptions& options) {
  std::vector<Step> steps = report_steps(options);
  if (!options.steps.empty()) {
    std::erase_if(steps, [&](const Step& step) {
      return std::find(options.steps.begin(), options.steps.end(), step.name) ==
             options.steps.end();
    });
  }
  return steps;
}

}  // namespace

int run_report(const ReportOptions& options, std::ostream& out, std::ostream& err) {
  const auto complain = [&err](const std::string& what) {
    fmt::print(err, "runstone-bench: {}\n", what);
    return 1;
  };
  std::error_code error;
  std::filesystem::create_directories(options.out + "/data", error);
  if (error) return complain("cannot make the folder " + options.out + ": " + error.message());
  StepFailures failures;
  const auto make_page = [&] { return write_page(options, failures); };
  if (!options.is_page_only) {
    if (const std::string why = objection(options); !why.empty()) return complain(why);
    std::ofstream log(options.out + "/run.log", std::ios::app);
    if (!log) return complain("cannot write " + options.out + "/run.log");
    const std::vector<Step> steps = wanted_steps(options);
    double expected = 0;
    for (const Step& step : steps) expected += step.seconds;
    ProgressBar bar(err, ::isatty(STDERR_FILENO) == 1, steps.size(), expected);
    for (const Step& step : steps) {
      bar.begin(step.name);
      if (!options.is_again && is_there(options, step)) {
        bar.end("is there", step.seconds, 0);
        continue;
      }
      const auto took = measure(options, step, log);
      if (interrupted())
        return complain("interrupted: the same command goes on where this one stopped");
      if (!took) failures[step.name] = took.error();
      bar.end(took ? duration_text(*took) : "failed: " + took.error(), step.seconds,
              took ? *took : 0);
      if (const auto made = make_page(); !made) return complain(made.error());
    }
  }
  const auto made = make_page();
  if (!made) return complain(made.error());
  fmt::print(out, "{}: {} figures, {} of them without their measurements\n", made->file,
             made->figures, made->missing);
  for (const auto& [step, why] : failures)
    fmt::print(err, "runstone-bench: {} failed: {}\n", step, why);
  return failures.empty() ? 0 : 1;
}

}  // namespace runstone::bench
