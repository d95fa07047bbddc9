#include "common/rights/right.hpp"

namespace runstone {
namespace {

constexpr std::array<std::string_view, kRightCount> kNames = {
    "see",       "build", "build_protected", "claim", "protect",   "look_back", "undo",
    "roll_back", "chat",  "moderate",        "grant", "administer"};

}  // namespace

std::string_view name_of(Right right) { return kNames[static_cast<std::size_t>(right)]; }

std::optional<Right> right_named(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<Right>(i);
  }
  return std::nullopt;
}

}  // namespace runstone
