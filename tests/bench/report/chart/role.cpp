#include "tests/bench/report/chart/role.hpp"

namespace runstone::bench::chart {

std::string class_of(Role role) {
  switch (role) {
    case Role::ours:
      return "c-ours";
    case Role::baseline:
      return "c-baseline";
    case Role::thesis:
      return "c-thesis";
    case Role::other:
      break;
  }
  return "c-rest";
}

std::string class_of(Role role, std::size_t index) {
  constexpr std::size_t kPalette = 8;  // as many as in chart_css()
  if (role == Role::other) return "c-other" + std::to_string(index % kPalette);
  return class_of(role) + (index > 0 ? "2" : "");
}

}  // namespace runstone::bench::chart
