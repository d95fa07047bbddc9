// StackDepths: a histogram of the depths of applied edit stacks, by powers of two. It shows how
// often deep stacks occur, for which the single sweep is made.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

namespace runstone {

class StackDepths {
 public:
  /// Buckets for the depths 1, 2, 3..4, 5..8, ..., 1,025..2,048, and more.
  static constexpr std::size_t kBuckets = 13;

  /// Counts a stack of this many edits. Empty stacks do not count. Cost: O(1).
  void add(std::size_t depth) {
    if (depth != 0) ++counts_[std::min<std::size_t>(std::bit_width(depth - 1), kBuckets - 1)];
  }
  StackDepths& operator+=(const StackDepths& other) {
    for (std::size_t i = 0; i < kBuckets; ++i) counts_[i] += other.counts_[i];
    return *this;
  }
  std::uint64_t count(std::size_t bucket) const { return counts_[bucket]; }
  /// Returns the largest depth of a bucket. The last bucket has none.
  static constexpr std::size_t depth_max(std::size_t bucket) { return std::size_t{1} << bucket; }
  /// Returns text such as "1:812 2:40 4:7": largest depth and count of each bucket that is not
  /// empty. The last bucket reads "2049+:3". Returns "none" if all are empty.
  std::string text() const {
    std::string out;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      if (counts_[i] == 0) continue;
      if (!out.empty()) out += ' ';
      out += i + 1 == kBuckets ? std::to_string(depth_max(i - 1) + 1) + '+'
                               : std::to_string(depth_max(i));
      out += ':' + std::to_string(counts_[i]);
    }
    return out.empty() ? "none" : out;
  }
  friend bool operator==(const StackDepths&, const StackDepths&) = default;

 private:
  std::array<std::uint64_t, kBuckets> counts_{};
};

}  // namespace runstone
