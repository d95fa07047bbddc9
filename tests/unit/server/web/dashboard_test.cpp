// packaging/grafana/runstone.json names only metrics that the gateway has.
#include <catch2/catch.hpp>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "tests/unit/server/web/metrics_page.hpp"

namespace runstone::test {
namespace {

/// Adds each text of `key` below the value.
void find_texts(const nlohmann::json& value, const std::string& key,
                std::vector<std::string>& out) {
  if (value.is_object() && value.contains(key) && value[key].is_string())
    out.push_back(value[key].get<std::string>());
  if (!value.is_structured()) return;
  for (const auto& child : value) find_texts(child, key, out);
}

/// Returns what is wrong with a question to Prometheus, or an empty text.
std::string wrong_question(const MetricsPage& page, const std::string& question) {
  static const std::regex kName(R"((rate\()?(runstone_[a-zA-Z0-9_]+))");
  bool names_any = false;
  for (std::sregex_iterator at(question.begin(), question.end(), kName), end; at != end; ++at) {
    names_any = true;
    const bool is_rate = (*at)[1].matched;
    std::string name = (*at)[2];
    bool is_bucket = false;
    for (const std::string suffix : {"_bucket", "_sum", "_count"}) {
      if (!name.ends_with(suffix) || page.families.contains(name)) continue;
      name.erase(name.size() - suffix.size());
      is_bucket = true;
    }
    const auto found = page.families.find(name);
    if (found == page.families.end()) return name + " is no metric";
    const std::string wanted = is_bucket ? "histogram" : is_rate ? "counter" : "gauge";
    if (found->second.type != wanted) return name + " is no " + wanted;
  }
  return names_any ? "" : "no metric";
}

}  // namespace

TEST_CASE("the dashboard names only metrics that exist, and as what they are", "[web][metrics]") {
  std::ifstream file(RUNSTONE_SOURCE_DIR "/packaging/grafana/runstone.json");
  const auto dashboard = nlohmann::json::parse(file, nullptr, false);
  REQUIRE(dashboard.is_object());
  const auto status = std::make_shared<const ServerStatus>(full_server_status());
  const WorldStatus world{"", "", status};
  const MetricsPage page = read_metrics_page(metrics_text(std::span(&world, 1), WebCounters{}));
  REQUIRE(page.wrong.empty());
  std::vector<std::string> questions;
  find_texts(dashboard, "expr", questions);
  find_texts(dashboard, "definition", questions);
  CHECK(questions.size() > 20);
  for (const std::string& question : questions) {
    CAPTURE(question);
    CHECK(wrong_question(page, question).empty());
  }
  CHECK(wrong_question(page, "runstone_pigs") == "runstone_pigs is no metric");
  CHECK(wrong_question(page, "runstone_bytes_in") == "runstone_bytes_in is no gauge");
  CHECK(wrong_question(page, "rate(runstone_sessions[5m])") == "runstone_sessions is no counter");
  CHECK(wrong_question(page, "up") == "no metric");
}

}  // namespace runstone::test
