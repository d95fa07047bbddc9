// The metrics page.
#include "server/web/metrics_text.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <string>

#include "common/core/version.hpp"
#include "server/web/metric_kinds.hpp"
#include "tests/unit/server/web/metrics_page.hpp"

namespace runstone::test {
namespace {

std::string metrics_page_of(const ServerStatus& status) {
  const WorldStatus world{"", "", std::make_shared<const ServerStatus>(status)};
  return metrics_text(std::span(&world, 1), WebCounters{});
}

double only_value(const MetricsPage& page, const std::string& name) {
  CAPTURE(name);
  REQUIRE(page.families.contains(name));
  REQUIRE(page.families.at(name).samples.size() == 1);
  return page.families.at(name).samples[0].value;
}

}  // namespace

TEST_CASE("a strict reader takes the page of metrics, and each metric has help and a type",
          "[web][metrics]") {
  const std::string text = metrics_page_of(full_server_status());
  CHECK(text.find("runstone-server repair\n# TYPE runstone_row_faults gauge\n") !=
        std::string::npos);
  const MetricsPage page = read_metrics_page(text);
  INFO(page.wrong);
  CHECK(page.wrong.empty());
  for (const auto& [name, family] : page.families) {
    CAPTURE(name);
    CHECK(name.starts_with("runstone_"));
    CHECK(family.type != "untyped");
  }
  for (const MetricKind& kind : metric_kinds())
    CHECK(page.families.contains("runstone_" + std::string(kind.name)));
  CHECK(only_value(page, "runstone_uptime_s") == 7);
  CHECK(only_value(page, "runstone_disk_free_bytes") == 1'000);
  CHECK(only_value(page, "runstone_world_bytes") == 2'000);
  CHECK(only_value(page, "runstone_wal_bytes") == 3'000);
  CHECK(only_value(page, "runstone_log_bytes") == 4'000);
  CHECK(only_value(page, "runstone_durable_lag_us") == 5);
  CHECK(page.families.at("runstone_uptime_s").type == "gauge");
  CHECK(page.families.at("runstone_edits_ordered").type == "counter");
}

TEST_CASE("waits are histograms of seconds", "[web][metrics]") {
  const MetricsPage page = read_metrics_page(metrics_page_of(full_server_status()));
  for (const char* name : {"runstone_edit_wait_seconds", "runstone_durable_wait_seconds"}) {
    REQUIRE(page.families.contains(name));
    CHECK(page.families.at(name).type == "histogram");
  }
  std::map<std::string, double> buckets, others;
  for (const MetricSample& sample : page.families.at("runstone_durable_wait_seconds").samples) {
    if (sample.labels.contains("le")) buckets[sample.labels.at("le")] = sample.value;
    if (!sample.labels.contains("le")) others[sample.name] = sample.value;
  }
  CHECK(buckets.at("0.002") == 0);
  CHECK(buckets.at("0.005") == 4);
  CHECK(buckets.at("1") == 4);
  CHECK(buckets.at("+Inf") == 5);
  CHECK(others.at("runstone_durable_wait_seconds_count") == 5);
  CHECK(others.at("runstone_durable_wait_seconds_sum") == Approx(4 * 0.003 + 2));
}

TEST_CASE("version and the reason of a world that cannot be written are labels", "[web][metrics]") {
  const std::string reason = R"(the "disk" \ is full)";
  const MetricsPage page = read_metrics_page(
      metrics_page_of(full_server_status("|version 1.2.3\n|read_only " + reason + "\n")));
  CHECK(page.wrong.empty());
  CHECK(only_value(page, "runstone_build_info") == 1);
  CHECK(page.families.at("runstone_build_info").samples[0].labels.at("version") == "1.2.3");
  CHECK(page.families.at("runstone_read_only_info").samples[0].labels.at("reason") == reason);
  const MetricsPage writable = read_metrics_page(metrics_page_of(full_server_status()));
  CHECK_FALSE(writable.families.contains("runstone_read_only_info"));
}

TEST_CASE("several worlds share the families of their metrics, and one may be down",
          "[web][metrics]") {
  ServerStatus down;
  down.why = "Connection refused";
  const WorldStatus worlds[] = {
      {"a", "A", std::make_shared<const ServerStatus>(full_server_status())},
      {"b", "B", std::make_shared<const ServerStatus>(full_server_status())},
      {"c", "C", std::make_shared<const ServerStatus>(down)}};
  const MetricsPage page = read_metrics_page(metrics_text(worlds, WebCounters{}));
  CHECK(page.wrong.empty());
  CHECK(page.families.at("runstone_up").samples.size() == 3);
  CHECK(page.families.at("runstone_uptime_s").samples.size() == 2);
}

TEST_CASE("a counter that only a later server has is a metric without a type", "[web][metrics]") {
  ServerStatus status = full_server_status();
  status.counters["flying_pigs"] = 3;
  const MetricsPage page = read_metrics_page(metrics_page_of(status));
  CHECK(page.wrong.empty());
  CHECK(page.families.at("runstone_flying_pigs").type == "untyped");
}

TEST_CASE("the strict reader of metrics refuses pages that break its rules", "[web][metrics]") {
  const std::string head = "# HELP a b\n# TYPE a counter\n";
  CHECK(read_metrics_page(head + "a 1\n").wrong.empty());
  for (const std::string& page :
       {head + "a 1", head + "a x\n", head + "b 1\n", head + "a -1\n", head + "a 1\na 2\n",
        head + "a{b=\"c} 1\n", head + "a{b=\"\\x\"} 1\n", head, std::string("a 1\n"),
        std::string("# HELP a b\na 1\n"), std::string("# TYPE a counter\na 1\n"),
        head + "a 1\n" + head + "a 2\n",
        std::string("# HELP a b\n# TYPE a histogram\na_bucket{le=\"1\"} 2\na_sum 1\na_count 2\n"),
        std::string("# HELP a b\n# TYPE a histogram\na_bucket{le=\"1\"} 2\n"
                    "a_bucket{le=\"+Inf\"} 1\na_sum 1\na_count 1\n")}) {
    CAPTURE(page);
    CHECK_FALSE(read_metrics_page(page).wrong.empty());
  }
}

}  // namespace runstone::test
