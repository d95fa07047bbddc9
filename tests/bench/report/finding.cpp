#include "tests/bench/report/finding.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <tuple>

#include "tests/bench/harness/machine_json.hpp"

namespace runstone::bench {
namespace {

using nlohmann::json;

constexpr int kFormat = 1;

Unexpected<std::string> broken(const std::string& file, const std::string& why) {
  return Unexpected<std::string>{fmt::format("{} cannot be used: {}", file, why)};
}

}  // namespace

std::string finding_file(const std::string& folder, const std::string& step) {
  return folder + "/data/" + step + ".json";
}

Result<void, std::string> write_finding(const std::string& folder, const Finding& finding) {
  const std::string file = finding_file(folder, finding.step), unfinished = file + ".part";
  std::error_code error;
  std::filesystem::create_directories(folder + "/data", error);
  const json content = {{"format", kFormat},
                        {"step", finding.step},
                        {"quick", finding.is_quick},
                        {"luanti", finding.luanti},
                        {"measured_at", finding.measured_at},
                        {"seconds", finding.seconds},
                        {"machine", json_of(finding.machine)},
                        {"result", finding.result}};
  {
    std::ofstream out(unfinished);
    out << content.dump(1, ' ', false, json::error_handler_t::replace) << '\n';
    out.flush();
    if (!out) return Unexpected<std::string>{"cannot write " + unfinished};
  }
  std::filesystem::rename(unfinished, file, error);
  if (error) return Unexpected<std::string>{"cannot write " + file + ": " + error.message()};
  return {};
}

Result<Finding, std::string> read_finding(const std::string& folder, const std::string& step) {
  const std::string file = finding_file(folder, step);
  std::ifstream in(file);
  if (!in) return Unexpected<std::string>{kNotMeasured};
  try {
    const json content = json::parse(in);
    if (content.at("format") != kFormat) return broken(file, "it is of another format");
    if (content.at("step") != step)
      return broken(file, "it is of the step " + content.at("step").dump());
    Finding out;
    out.step = step;
    content.at("quick").get_to(out.is_quick);
    content.at("luanti").get_to(out.luanti);
    content.at("measured_at").get_to(out.measured_at);
    content.at("seconds").get_to(out.seconds);
    const json& machine = content.at("machine");
    machine.at("cpu").get_to(out.machine.cpu);
    machine.at("cores").get_to(out.machine.cores);
    machine.at("compiler").get_to(out.machine.compiler);
    machine.at("commit").get_to(out.machine.commit);
    machine.at("simd").get_to(out.machine.simd);
    out.result = content.at("result");
    return out;
  } catch (const json::exception& error) {
    return broken(file, error.what());
  }
}

bool is_comparable(const Finding& a, const Finding& b) {
  const auto of = [](const Finding& f) {
    return std::tie(f.machine.cpu, f.machine.cores, f.machine.compiler, f.machine.commit,
                    f.machine.simd, f.is_quick, f.luanti);
  };
  return of(a) == of(b);
}

}  // namespace runstone::bench
