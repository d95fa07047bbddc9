// Random texts of patterns, with and without needless blanks, quotes and parentheses. The mixes
// name air, stone, oak planks and moss, and the filters lamps as well.
#pragma once
#include <array>
#include <string>

#include "common/core/hash.hpp"

namespace runstone::test {

class RandomPattern {
 public:
  explicit RandomPattern(SplitMix64& rng) : rng_(rng) {}

  std::string mix(int depth = 0) {
    switch (depth > 2 ? 0 : rng_.below(5)) {
      case 1:
        return "noise " + std::to_string(rng_.between(1, 20)) + ":" + blank() + list(depth);
      case 2:
        return "y " + range(-30) + ":" + parts(depth, 2);
      case 3:
        return "distance " + range(0) + ":" + parts(depth, 2);
      default:
        return list(depth);
    }
  }
  std::string filter(int depth = 0) {
    std::string out = condition(depth);
    for (int more = depth > 2 ? 0 : rng_.between(0, 2); more > 0; --more)
      out += (rng_.below(2) == 0 ? " and " : " or ") + condition(depth);
    return out;
  }

 private:
  std::string blank() { return rng_.below(2) == 0 ? "" : " "; }
  std::string name() {
    constexpr std::array<const char*, 5> kNames = {"air", "stone", "\"oak planks\"", "moss",
                                                   "\"stone\""};
    return kNames[rng_.below(kNames.size())];
  }
  std::string range(std::int32_t lowest) {
    const std::int32_t low = rng_.between(lowest, 20);
    return std::to_string(low) + ".." + std::to_string(low + rng_.between(1, 30));
  }
  std::string part(int depth) {
    return rng_.below(4) == 0 && depth < 3 ? "(" + mix(depth + 1) + ")" : name();
  }
  std::string parts(int depth, int least) {
    std::string out = part(depth);
    for (int more = rng_.between(least - 1, 3); more > 0; --more)
      out += "," + blank() + part(depth);
    return out;
  }
  std::string list(int depth) {
    if (rng_.below(2) == 0) return parts(depth, 1);
    std::string out;
    for (int count = rng_.between(1, 4); count > 0; --count) {
      out += std::to_string(rng_.between(1, 90)) + blank() + "%" + blank() + part(depth);
      if (count > 1) out += blank() + ",";
    }
    return out;
  }
  std::string names() {
    std::string out = name();
    for (int more = rng_.between(0, 2); more > 0; --more)
      out += " or " + (rng_.below(3) == 0 ? "lamp" : name());
    return out;
  }
  std::string condition(int depth) {
    switch (rng_.below(depth > 2 ? 9U : 11U)) {
      case 0:
        return "is " + names();
      case 1:
        return "on " + names();
      case 2:
        return "under " + names();
      case 3:
        return "beside " + names();
      case 4:
        return "exposed";
      case 5:
        return "solid";
      case 6:
        return "above " + std::to_string(rng_.between(-40, 40));
      case 7:
        return "below " + std::to_string(rng_.between(-40, 40));
      case 8:
        return "noise " + std::to_string(rng_.between(0, 100)) + "%" +
               (rng_.below(2) == 0 ? "" : " " + std::to_string(rng_.between(1, 9)));
      case 9:
        return "not " + condition(depth + 1);
      default:
        return "(" + blank() + filter(depth + 1) + ")";
    }
  }

  SplitMix64& rng_;
};

}  // namespace runstone::test
