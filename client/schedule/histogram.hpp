// Histogram: a histogram of durations with log-linear buckets. A percentile is off by at most 1/256
// of its value, and values below 256 are exact. No sample is dropped: an event that never happened
// counts as infinite. Source: the bucket layout of HdrHistogram (G. Tene).
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace runstone {

class Histogram {
 public:
  static constexpr std::int64_t kInfinite = std::numeric_limits<std::int64_t>::max();
  /// Larger values count as this one.
  static constexpr std::int64_t kValueMax = (std::int64_t{1} << 42) - 1;

  /// Adds a value. A negative value counts as 0 and in below_zero(): two clocks differ by more than
  /// the duration.
  void add(std::int64_t value);
  void add_infinite() { ++infinite_; }
  void merge(const Histogram& other);

  /// Returns the number of values, infinite ones included.
  std::uint64_t count() const { return finite_ + infinite_; }
  std::uint64_t infinite() const { return infinite_; }
  std::uint64_t below_zero() const { return below_zero_; }
  /// Returns the smallest value that is not exceeded by at least this share of all values. Requires
  /// 0 < share <= 1. Returns kInfinite if the rank is among the infinite values, or nullopt while
  /// empty. Nearest rank: percentile(1) is max(), up to the bucket.
  std::optional<std::int64_t> percentile(double share) const;
  std::optional<std::int64_t> max() const;  // exact
  std::optional<double> mean() const;       // of the finite values

  /// The number of finite values in [from, below). It is exact, because both limits are bucket
  /// limits.
  struct Row {
    std::int64_t from = 0, below = 1;
    std::uint64_t count = 0;
    friend bool operator==(const Row&, const Row&) = default;
  };
  /// Returns two rows per power of two: 0, 1, 2, 3, 4 to 5, 6 to 7, 8 to 11, 12 to 15, ...
  /// Ascending, without empty rows.
  std::vector<Row> rows() const;

 private:
  std::vector<std::uint64_t> buckets_;
  std::uint64_t finite_ = 0, infinite_ = 0, below_zero_ = 0;
  std::int64_t max_ = 0;
  double sum_ = 0;
};

}  // namespace runstone
