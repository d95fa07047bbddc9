#include "server/interest/cache_claims.hpp"

#include <algorithm>
#include <iterator>

#include "common/core/assert.hpp"
#include "protocol/codec/view_tiles.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

// A block takes 20 KB at most.
constexpr std::size_t kBlockClaimsMax = 512;

bool is_before(const CachedChunk& claim, const ChunkKey& key) { return claim.key < key; }

/// Frees memory of a block that is mostly unused.
void fit(std::vector<CachedChunk>& block) {
  if (block.size() < block.capacity() / 4) block.shrink_to_fit();
}

}  // namespace

std::size_t CacheClaims::block_of(const ChunkKey& key) const {
  const auto behind =
      std::upper_bound(blocks_.begin(), blocks_.end(), key,
                       [](const ChunkKey& k, const Block& block) { return k < block.front().key; });
  return behind == blocks_.begin() ? 0 : static_cast<std::size_t>(behind - blocks_.begin()) - 1;
}

void CacheClaims::merge(std::size_t at, std::span<const CachedChunk> claims) {
  Block& block = blocks_[at];
  Block merged;
  merged.reserve(block.size() + claims.size());
  auto old = block.begin();
  for (const CachedChunk& claim : claims) {
    while (old != block.end() && old->key < claim.key) merged.push_back(*old++);
    if (old != block.end() && old->key == claim.key) ++old;
    merged.push_back(claim);
  }
  merged.insert(merged.end(), old, block.end());
  count_ += merged.size() - block.size();
  if (merged.size() <= kBlockClaimsMax) {
    block = std::move(merged);
    return;
  }
  // Both halves fit, because a message of claims has at most half as many as a block.
  static_assert(kCachedChunksMax <= kBlockClaimsMax);
  const auto middle = merged.begin() + static_cast<std::ptrdiff_t>(merged.size() / 2);
  block.assign(merged.begin(), middle);
  blocks_.emplace(blocks_.begin() + static_cast<std::ptrdiff_t>(at) + 1, middle, merged.end());
}

bool CacheClaims::add(std::span<const CachedChunk> claims) {
  RUNSTONE_ASSERT(claims.size() <= kCachedChunksMax);
  while (!claims.empty()) {
    const ChunkKey& key = claims.front().key;
    const bool is_behind_all = blocks_.empty() || blocks_.back().back().key < key;
    if (is_behind_all &&
        (blocks_.empty() || blocks_.back().size() + claims.size() > kBlockClaimsMax)) {
      blocks_.emplace_back(claims.begin(), claims.end());
      count_ += claims.size();
      break;
    }
    const std::size_t at = block_of(key);
    std::size_t here = claims.size();
    if (at + 1 < blocks_.size()) {
      const ChunkKey& next = blocks_[at + 1].front().key;
      here = static_cast<std::size_t>(
          std::lower_bound(claims.begin(), claims.end(), next, is_before) - claims.begin());
    }
    merge(at, claims.first(here));
    claims = claims.subspan(here);
  }
  return count_ <= kClaimsPerSessionMax;
}

const CachedChunk* CacheClaims::find(const ChunkKey& key) const {
  if (blocks_.empty()) return nullptr;
  const Block& block = blocks_[block_of(key)];
  const auto found = std::lower_bound(block.begin(), block.end(), key, is_before);
  return found == block.end() || found->key != key ? nullptr : &*found;
}

void CacheClaims::drop(const ChunkKey& key) {
  if (blocks_.empty()) return;
  const std::size_t at = block_of(key);
  Block& block = blocks_[at];
  const auto found = std::lower_bound(block.begin(), block.end(), key, is_before);
  if (found == block.end() || found->key != key) return;
  block.erase(found);
  --count_;
  if (block.empty()) {
    blocks_.erase(blocks_.begin() + static_cast<std::ptrdiff_t>(at));
  } else {
    fit(block);
  }
}

void CacheClaims::keep(const View& view) {
  for (Block& block : blocks_) {
    const std::size_t outside = std::erase_if(
        block, [&view](const CachedChunk& claim) { return !contains_key(view, claim.key); });
    count_ -= outside;
    if (!block.empty()) fit(block);
  }
  std::erase_if(blocks_, [](const Block& block) { return block.empty(); });
}

void CacheClaims::clear() {
  blocks_.clear();
  count_ = 0;
}

}  // namespace runstone
