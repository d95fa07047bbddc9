#include "tests/bench/report/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace runstone::bench {

Findings Findings::read(const std::string& folder, const std::vector<std::string>& steps,
                        const StepFailures& failures) {
  Findings out;
  for (const std::string& step : steps) {
    auto found = read_finding(folder, step);
    if (found) {
      out.found_.emplace(step, *std::move(found));
    } else {
      out.missing_.emplace(step, found.error());
    }
    if (const auto failed = failures.find(step); failed != failures.end())
      out.failed_.insert(*failed);
  }
  std::ptrdiff_t most = 0;
  for (const auto& each : out.found_) {
    const Finding& one = each.second;
    const auto alike =
        std::count_if(out.found_.begin(), out.found_.end(),
                      [&one](const auto& other) { return is_comparable(one, other.second); });
    if (alike > most) {
      most = alike;
      out.common_ = &one;
    }
  }
  return out;
}

const Finding* Findings::find(const std::string& step) const {
  const auto found = found_.find(step);
  return found == found_.end() ? nullptr : &found->second;
}

Rows Findings::rows(const std::string& step, const char* member) const {
  const Finding* finding = find(step);
  if (finding == nullptr) return {};
  const nlohmann::json& result = finding->result;
  if (result.is_array()) return Rows(result);
  if (!result.is_object()) return {};
  const auto found = result.find(member);
  return found == result.end() ? Rows() : Rows(*found);
}

Rows Findings::object(const std::string& step, const std::string& member) const {
  const Finding* finding = find(step);
  if (finding == nullptr) return {};
  const nlohmann::json& result = finding->result;
  if (member.empty() || !result.is_object()) return member.empty() ? Rows::of(result) : Rows();
  const auto found = result.find(member);
  return found == result.end() ? Rows() : Rows::of(*found);
}

Rows Findings::figures(const std::vector<std::string>& steps) const {
  Rows out;
  for (const std::string& step : steps) out.add(rows(step, "figures"));
  return out;
}

std::vector<std::string> Findings::doubts(const std::vector<std::string>& steps) const {
  std::vector<std::string> out, absent;
  for (const std::string& step : steps) {
    const Finding* finding = find(step);
    const auto why = missing_.find(step);
    if (const auto failed = failed_.find(step); failed != failed_.end()) {
      out.push_back(fmt::format("{} failed in this run: {}.{}", step, failed->second,
                                finding == nullptr ? "" : " What is shown is older."));
      if (finding == nullptr) continue;
    }
    if (finding == nullptr && (why == missing_.end() || why->second == kNotMeasured)) {
      absent.push_back(step);
    } else if (finding == nullptr) {
      out.push_back(fmt::format("{}: {}.", step, why->second));
    } else if (!is_comparable(*finding, *common_)) {
      const Machine& m = finding->machine;
      out.push_back(
          fmt::format("{} was measured on something else than the rest: {}, {} cores; {}; "
                      "commit {}; world {}; {}.",
                      step, m.cpu, m.cores, m.compiler, m.commit, finding->luanti,
                      finding->is_quick ? "a quick run" : "a full run"));
    }
  }
  if (!absent.empty()) out.push_back(fmt::format("Not measured: {}.", fmt::join(absent, ", ")));
  return out;
}

bool Findings::is_missing(const std::vector<std::string>& steps) const {
  return std::none_of(steps.begin(), steps.end(),
                      [this](const std::string& step) { return find(step) != nullptr; });
}

}  // namespace runstone::bench
