#include "client/report/histogram_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

namespace runstone {
namespace {

nlohmann::ordered_json value_json(const std::optional<std::int64_t>& us) {
  if (!us) return nullptr;
  if (*us == Histogram::kInfinite) return "infinite";
  return *us;
}

std::string value_text(const std::optional<std::int64_t>& us) {
  if (!us) return "-";
  if (*us == Histogram::kInfinite) return "infinite";
  return fmt::format("{:.2f}", static_cast<double>(*us) / 1000);
}

}  // namespace

nlohmann::ordered_json histogram_json(const Histogram& us) {
  nlohmann::ordered_json json = {{"count", us.count()},
                                 {"infinite", us.infinite()},
                                 {"below_zero", us.below_zero()},
                                 {"mean", nullptr}};
  if (us.mean()) json["mean"] = *us.mean();
  json["p50"] = value_json(us.percentile(0.5));
  json["p90"] = value_json(us.percentile(0.9));
  json["p99"] = value_json(us.percentile(0.99));
  json["p99_9"] = value_json(us.percentile(0.999));
  json["max"] = value_json(us.max());
  json["rows"] = nlohmann::ordered_json::array();
  for (const Histogram::Row& row : us.rows())
    json["rows"].push_back({row.from, row.below, row.count});
  return json;
}

std::string histogram_line(std::string_view what, const Histogram& us) {
  return fmt::format("{}, ms: p50 {} p90 {} p99 {} p99.9 {} max {}, {} counted\n", what,
                     value_text(us.percentile(0.5)), value_text(us.percentile(0.9)),
                     value_text(us.percentile(0.99)), value_text(us.percentile(0.999)),
                     value_text(us.max()), us.count());
}

std::string histogram_bars(const Histogram& us) {
  constexpr std::size_t kBarMax = 50;
  const auto rows = us.rows();
  std::uint64_t most = 1;
  for (const auto& row : rows) most = std::max(most, row.count);
  std::string out;
  for (const auto& row : rows) {
    const auto bar = static_cast<std::size_t>((row.count * kBarMax + most - 1) / most);
    out += fmt::format("  below {:>9.3f} ms {:>10} {}\n", static_cast<double>(row.below) / 1000,
                       row.count, std::string(bar, '#'));
  }
  if (us.infinite() != 0) out += fmt::format("  never              {:>10}\n", us.infinite());
  return out;
}

}  // namespace runstone
