// MetricsPage: a strict reader of the text format of Prometheus, version 0.0.4. It shares no code
// with the writer.
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "server/runtime/counters_line.hpp"
#include "server/web/metrics_text.hpp"
#include "tests/unit/server/world/fake_environment.hpp"

namespace runstone::test {

struct MetricSample {
  std::string name;                           // with _bucket, _sum or _count
  std::map<std::string, std::string> labels;  // unescaped
  double value = 0;
};
struct MetricsFamily {
  std::string help, type;
  std::vector<MetricSample> samples;
};
struct MetricsPage {
  std::map<std::string, MetricsFamily> families;
  std::string wrong;  // the first line that breaks a rule, with the rule; empty: none
};

class MetricsPageReader {
 public:
  explicit MetricsPageReader(const std::string& text) {
    if (text.empty() || text.back() != '\n') break_rule("the last line has no line break");
    std::istringstream lines(text);
    for (std::string line; page_.wrong.empty() && std::getline(lines, line);) read(line);
    for (const auto& [name, family] : page_.families) check_family(name, family);
  }
  const MetricsPage& page() const { return page_; }

 private:
  void break_rule(const std::string& rule) {
    if (page_.wrong.empty()) page_.wrong = rule + ": " + line_;
  }
  /// Takes a name of a metric or a label from the front of a text.
  static std::string take_metric_name(std::string& text) {
    std::size_t end = 0;
    while (end < text.size() &&
           (std::isalpha(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_' ||
            text[end] == ':' || (end > 0 && std::isdigit(static_cast<unsigned char>(text[end])))))
      ++end;
    const std::string name = text.substr(0, end);
    text.erase(0, end);
    return name;
  }
  void read(const std::string& line) {
    line_ = line;
    if (line.empty()) return break_rule("an empty line");
    if (line[0] == '#') return read_comment(line);
    read_sample(line);
  }
  void read_comment(std::string line) {
    const std::string kind = line.substr(0, 7);
    if (kind != "# HELP " && kind != "# TYPE ") return break_rule("neither HELP nor TYPE");
    line.erase(0, 7);
    const std::string name = take_metric_name(line);
    if (name.empty() || line.size() < 2 || line[0] != ' ') return break_rule("no name or no text");
    const std::string text = line.substr(1);
    if (kind == "# HELP ") {
      if (!page_.families.emplace(name, MetricsFamily{text, "", {}}).second)
        return break_rule("a second HELP");
      current_ = name;
      return;
    }
    if (name != current_) return break_rule("a TYPE that does not follow its HELP");
    MetricsFamily& family = page_.families[name];
    if (!family.type.empty() || !family.samples.empty()) return break_rule("a late TYPE");
    if (!std::set<std::string>{"counter", "gauge", "histogram", "summary", "untyped"}.contains(
            text))
      return break_rule("an unknown type");
    family.type = text;
  }
  void read_sample(std::string line) {
    MetricSample sample;
    sample.name = take_metric_name(line);
    if (sample.name.empty()) return break_rule("no name");
    if (line.starts_with('{') && !read_labels(line, sample)) return;
    if (!line.starts_with(' ')) return break_rule("no blank before the value");
    line.erase(0, 1);
    char* end = nullptr;
    sample.value = std::strtod(line.c_str(), &end);
    if (line.empty() || *end != '\0' || std::isspace(static_cast<unsigned char>(line[0])) != 0)
      return break_rule("no number");
    MetricsFamily& family = page_.families[current_];
    std::string suffix;
    if (sample.name.starts_with(current_)) suffix = sample.name.substr(current_.size());
    const bool is_histogram = family.type == "histogram";
    const bool fits = is_histogram ? suffix == "_bucket" || suffix == "_sum" || suffix == "_count"
                                   : sample.name == current_;
    if (family.type.empty() || !fits) return break_rule("a sample outside its family");
    for (const MetricSample& other : family.samples) {
      if (other.name == sample.name && other.labels == sample.labels)
        return break_rule("a second sample with these labels");
    }
    if (family.type == "counter" && sample.value < 0) return break_rule("a counter below 0");
    family.samples.push_back(sample);
  }
  bool read_labels(std::string& line, MetricSample& sample) {
    line.erase(0, 1);
    while (!line.starts_with('}')) {
      const std::string name = take_metric_name(line);
      if (name.empty() || !line.starts_with("=\"")) return break_rule("a wrong label"), false;
      line.erase(0, 2);
      std::string value;
      while (!line.empty() && line[0] != '"') {
        if (line[0] == '\\') {
          line.erase(0, 1);
          if (line.empty() || std::string("\\\"n").find(line[0]) == std::string::npos)
            return break_rule("a wrong escape"), false;
          value += line[0] == 'n' ? '\n' : line[0];
        } else {
          value += line[0];
        }
        line.erase(0, 1);
      }
      if (line.empty()) return break_rule("a label without an end"), false;
      line.erase(0, 1);
      if (!sample.labels.emplace(name, value).second) return break_rule("a label twice"), false;
      if (line.starts_with(',')) line.erase(0, 1);
    }
    line.erase(0, 1);
    return true;
  }
  /// The buckets of a histogram ascend, and the last one is the count.
  void check_family(const std::string& name, const MetricsFamily& family) {
    line_ = name;
    if (family.help.empty() || family.type.empty()) return break_rule("no HELP or no TYPE");
    if (family.samples.empty()) return break_rule("no sample");
    if (family.type != "histogram") return;
    double bound = -1, count = 0;
    std::optional<double> infinite, all, sum;
    for (const MetricSample& sample : family.samples) {
      if (sample.labels.contains("world") && sample.labels.at("world") != "a") continue;
      if (sample.name == name + "_count") all = sample.value;
      if (sample.name == name + "_sum") sum = sample.value;
      if (sample.name != name + "_bucket") continue;
      if (!sample.labels.contains("le")) return break_rule("a bucket without a bound");
      const std::string& text = sample.labels.at("le");
      const double at_most = std::strtod(text.c_str(), nullptr);
      if (at_most <= bound || sample.value < count) return break_rule("buckets do not ascend");
      bound = at_most;
      count = sample.value;
      if (std::isinf(at_most)) infinite = sample.value;
    }
    if (!infinite || !all || !sum || *infinite != *all) break_rule("no whole histogram");
  }

  MetricsPage page_;
  std::string line_, current_;
};

inline MetricsPage read_metrics_page(const std::string& text) {
  return MetricsPageReader(text).page();
}

/// Returns the status of a server with every counter that there is, as a gateway reads it.
inline ServerStatus full_server_status(const std::string& more_lines = "") {
  FakeEnvironment environment;
  WorldServer world(WorldConfig{}, WorldStart{}, environment,
                    [](std::span<std::uint8_t> out) { std::fill(out.begin(), out.end(), 9); });
  RuntimeCounters runtime;
  runtime.health = {7'000'000, 1'000, 2'000, 3'000, 4'000, 5};
  runtime.backups = BackupState{};
  runtime.backups->last.emplace();
  runtime.durable_waits.add(3'000, 4);
  runtime.durable_waits.add(2'000'000);
  const std::string line = counters_line(world, NetCounters(), {}, runtime);
  const auto read = parse_server_status("|" + line + "\n" + more_lines + "=ok\n");
  REQUIRE(read.has_value());
  return *read;
}

}  // namespace runstone::test
