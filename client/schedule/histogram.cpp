#include "client/schedule/histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace runstone {
namespace {

constexpr unsigned kSubBits = 8;  // 2^8 exact values, then 2^7 buckets per power of two
constexpr std::uint64_t kSub = 1U << kSubBits;

std::size_t bucket_of(std::uint64_t value) {
  if (value < kSub) return static_cast<std::size_t>(value);
  const auto shift = static_cast<unsigned>(std::bit_width(value)) - kSubBits;
  return static_cast<std::size_t>(kSub + (shift - 1) * (kSub / 2) + ((value >> shift) - kSub / 2));
}

/// Returns the middle of a bucket's values.
std::int64_t value_of(std::size_t bucket) {
  if (bucket < kSub) return static_cast<std::int64_t>(bucket);
  const std::uint64_t shift = (bucket - kSub) / (kSub / 2) + 1;
  const std::uint64_t sub = (bucket - kSub) % (kSub / 2) + kSub / 2;
  return static_cast<std::int64_t>((sub << shift) + (std::uint64_t{1} << (shift - 1)));
}

}  // namespace

void Histogram::add(std::int64_t value) {
  if (value < 0) ++below_zero_;
  value = std::clamp<std::int64_t>(value, 0, kValueMax);
  const std::size_t bucket = bucket_of(static_cast<std::uint64_t>(value));
  if (buckets_.size() <= bucket) buckets_.resize(bucket + 1);
  ++buckets_[bucket];
  ++finite_;
  max_ = std::max(max_, value);
  sum_ += static_cast<double>(value);
}

void Histogram::merge(const Histogram& other) {
  if (buckets_.size() < other.buckets_.size()) buckets_.resize(other.buckets_.size());
  for (std::size_t i = 0; i < other.buckets_.size(); ++i) buckets_[i] += other.buckets_[i];
  finite_ += other.finite_;
  infinite_ += other.infinite_;
  below_zero_ += other.below_zero_;
  max_ = std::max(max_, other.max_);
  sum_ += other.sum_;
}

std::optional<std::int64_t> Histogram::percentile(double share) const {
  if (count() == 0) return std::nullopt;
  const auto rank = std::clamp<std::uint64_t>(
      static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count()))), 1, count());
  if (rank > finite_) return kInfinite;
  std::uint64_t seen = 0;
  for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
    seen += buckets_[bucket];
    if (seen >= rank) return std::min(value_of(bucket), max_);
  }
  return max_;
}

std::optional<std::int64_t> Histogram::max() const {
  if (count() == 0) return std::nullopt;
  return infinite_ != 0 ? kInfinite : max_;
}

std::optional<double> Histogram::mean() const {
  if (finite_ == 0) return std::nullopt;
  return sum_ / static_cast<double>(finite_);
}

std::vector<Histogram::Row> Histogram::rows() const {
  std::vector<Row> out;
  for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
    if (buckets_[bucket] == 0) continue;
    const auto value = static_cast<std::uint64_t>(value_of(bucket));
    const std::uint64_t power = std::bit_floor(value), wide = std::max<std::uint64_t>(power / 2, 1);
    const std::uint64_t from = value < power + wide ? power : power + wide;
    const auto first = static_cast<std::int64_t>(from);
    if (out.empty() || out.back().from != first) {
      out.push_back({first, static_cast<std::int64_t>(from + wide), 0});
    }
    out.back().count += buckets_[bucket];
  }
  return out;
}

}  // namespace runstone
