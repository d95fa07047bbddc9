#include "common/materials/colour_quantiser.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

std::size_t bin_of(const ColourQuantiser::Rgb& colour) {
  return std::size_t{colour[0]} >> 3 << 10 | std::size_t{colour[1]} >> 3 << 5 | colour[2] >> 3;
}

unsigned bin_channel(std::size_t bin, unsigned channel) {
  return static_cast<unsigned>(bin >> (10 - 5 * channel) & 31);
}

/// Bins that get one colour.
struct ColourBox {
  std::vector<std::size_t> bins;
  std::uint64_t count = 0;
  unsigned channel = 0;  // along which the bins reach farthest
  unsigned reach = 0;
};

ColourBox colour_box(std::vector<std::size_t> bins, const std::vector<std::uint64_t>& counts) {
  ColourBox out{std::move(bins)};
  for (const std::size_t bin : out.bins) out.count += counts[bin];
  for (unsigned channel = 0; channel < 3; ++channel) {
    unsigned low = 31, high = 0;
    for (const std::size_t bin : out.bins) {
      low = std::min(low, bin_channel(bin, channel));
      high = std::max(high, bin_channel(bin, channel));
    }
    if (high - low > out.reach) {
      out.reach = high - low;
      out.channel = channel;
    }
  }
  return out;
}

}  // namespace

void ColourQuantiser::add(Rgb colour, std::uint64_t times) {
  Bin& bin = bins_[bin_of(colour)];
  bin.count += times;
  for (std::size_t i = 0; i < 3; ++i) bin.sums[i] += times * colour[i];
  if (!is_exact_) return;
  exact_.try_emplace(colour, std::uint16_t{0});
  if (exact_.size() > kQuantisedColoursMax) {
    is_exact_ = false;
    exact_.clear();
  }
}

void ColourQuantiser::choose(std::size_t colours_max) {
  RUNSTONE_ASSERT(colours_max >= 1 && colours_max <= kQuantisedColoursMax);
  colours_.clear();
  is_exact_ = is_exact_ && exact_.size() <= colours_max;
  if (is_exact_) {
    for (auto& [colour, index] : exact_) {
      index = static_cast<std::uint16_t>(colours_.size());
      colours_.push_back(colour);
    }
    return;
  }
  std::vector<std::uint64_t> counts(bins_.size());
  std::vector<std::size_t> used;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    counts[bin] = bins_[bin].count;
    if (counts[bin] > 0) used.push_back(bin);
  }
  std::vector<ColourBox> boxes;
  boxes.push_back(colour_box(std::move(used), counts));
  while (boxes.size() < colours_max) {
    const auto largest =
        std::max_element(boxes.begin(), boxes.end(), [](const ColourBox& a, const ColourBox& b) {
          return a.count * a.reach < b.count * b.reach;
        });
    if (largest->reach == 0) break;
    std::vector<std::size_t> bins = std::move(largest->bins);
    const unsigned channel = largest->channel;
    std::sort(bins.begin(), bins.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(bin_channel(a, channel), a) < std::pair(bin_channel(b, channel), b);
    });
    std::uint64_t below = 0;
    std::size_t middle = 0;
    while (middle + 1 < bins.size() && below + counts[bins[middle]] <= largest->count / 2)
      below += counts[bins[middle++]];
    middle = std::clamp<std::size_t>(middle, 1, bins.size() - 1);
    std::vector<std::size_t> upper(bins.begin() + static_cast<std::ptrdiff_t>(middle), bins.end());
    bins.resize(middle);
    *largest = colour_box(std::move(bins), counts);
    boxes.push_back(colour_box(std::move(upper), counts));
  }
  for (const ColourBox& box : boxes) {
    std::array<std::uint64_t, 3> sums{};
    for (const std::size_t bin : box.bins) {
      bins_[bin].index = static_cast<std::uint16_t>(colours_.size());
      for (std::size_t i = 0; i < 3; ++i) sums[i] += bins_[bin].sums[i];
    }
    Rgb mean{};
    for (std::size_t i = 0; i < 3; ++i)
      mean[i] = static_cast<std::uint8_t>((sums[i] + box.count / 2) / box.count);
    colours_.push_back(mean);
  }
}

std::uint16_t ColourQuantiser::index_of(Rgb colour) const {
  if (is_exact_) return exact_.at(colour);
  return bins_[bin_of(colour)].index;
}

}  // namespace runstone
