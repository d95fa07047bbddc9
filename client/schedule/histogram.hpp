// Histogram: how often which duration came, in log-linear buckets, so that a percentile is off by at most
// 1/256 of itself (values below 256 are exact) and nothing is dropped: what never happened counts as
// infinite. Source: the bucket layout of HdrHistogram (G. Tene).
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace runstone {

class Histogram {
 public:
  static constexpr std::int64_t kInfinite = std::numeric_limits<std::int64_t>::max();
  static constexpr std::int64_t kValueMax =
      (std::int64_t{1} << 42) - 1;  // larger values count as this one

  /// Negative values count as 0 (two clocks differ by more than the duration) and in below_zero().
  void add(std::int64_t value);
  void add_infinite() { ++infinite_; }
  void merge(const Histogram& other);

  /// Infinite ones included.
  std::uint64_t count() const { return finite_ + infinite_; }
  std::uint64_t infinite() const { return infinite_; }
  std::uint64_t below_zero() const { return below_zero_; }
  /// Smallest value that at least this share (0 < share <= 1) of all does not exceed; kInfinite if the rank
  /// falls among the infinite ones; none while empty. Nearest rank, so percentile(1) is max() up to the
  /// bucket.
  std::optional<std::int64_t> percentile(double share) const;
  std::optional<std::int64_t> max() const;  // exact
  std::optional<double> mean() const;       // of the finite ones

  /// How many finite values are in [from, below). Exact: every limit is one of a bucket, too.
  struct Row {
    std::int64_t from = 0, below = 1;
    std::uint64_t count = 0;
    friend bool operator==(const Row&, const Row&) = default;
  };
  /// Two rows a power of two: 0, 1, 2, 3, 4 to 5, 6 to 7, 8 to 11, 12 to 15, ... Ascending, without empty rows.
  std::vector<Row> rows() const;

 private:
  std::vector<std::uint64_t> buckets_;
  std::uint64_t finite_ = 0, infinite_ = 0, below_zero_ = 0;
  std::int64_t max_ = 0;
  double sum_ = 0;
};

}  // namespace runstone
