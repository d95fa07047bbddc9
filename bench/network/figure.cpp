#include "bench/network/figure.hpp"

#include <fmt/ostream.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/harness/machine_json.hpp"
#include "bench/harness/target_json.hpp"

namespace runstone::bench {
namespace {

nlohmann::ordered_json json_of(double value) {
  if (std::isinf(value)) return "inf";
  return value;
}

}  // namespace

std::string number_text(double value) {
  if (std::isinf(value)) return "inf";
  const double size = std::fabs(value);
  return fmt::format("{:.{}f}", value, size < 10 ? 2 : size < 1000 ? 1 : 0);
}

void write_csv(std::span<const Figure> figures, std::ostream& out) {
  fmt::print(out, "experiment,profile,link,case,figure,value\n");
  for (const Figure& figure : figures) {
    fmt::print(out, "{},{},{},{},{},{}\n", figure.experiment, figure.profile, figure.link,
               figure.what, figure.name, figure.value);
  }
}

void write_json(const Machine& machine, std::span<const Figure> figures,
                std::span<const Target> targets, std::ostream& out) {
  nlohmann::ordered_json json;
  json["machine"] = json_of(machine);
  json["figures"] = nlohmann::ordered_json::array();
  for (const Figure& figure : figures) {
    json["figures"].push_back({{"experiment", figure.experiment},
                               {"profile", figure.profile},
                               {"link", figure.link},
                               {"case", figure.what},
                               {"figure", figure.name},
                               {"value", json_of(figure.value)}});
  }
  json["bars"] = json_of(targets);
  fmt::print(out, "{}\n", json.dump(1));
}

}  // namespace runstone::bench
