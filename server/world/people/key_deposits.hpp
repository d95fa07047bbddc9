// KeyDeposits: the sealed keys that players leave for another device (docs/protocol.md). They are
// in memory only, for kDepositUs, and each can be taken once. Nobody can open them without the
// code. Bounds: kDepositsMax in all, kDepositsPerAddress of one address, one of a key: a new one
// replaces it.
// Thread: the world strand. Times are arguments (microseconds of one steady clock).
#pragma once
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/address_block.hpp"
#include "common/core/public_key.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/device_code.hpp"

namespace runstone {

inline constexpr TimeUs kDepositUs = TimeUs{600} * 1'000'000;
inline constexpr std::size_t kDepositsMax = 1'024;
/// More than a school class behind one address needs at a time.
inline constexpr std::size_t kDepositsPerAddress = 32;

class KeyDeposits {
 public:
  /// Keeps a sealed key. Fails if it cannot be kept: why, as a sentence. Cost: O(deposits).
  Result<void, std::string> put(const PublicKey& owner, AddressBlock from, KeyDeposit deposit,
                                TimeUs now_us) {
    std::erase_if(kept_, [now_us](const Kept& kept) { return kept.until_us <= now_us; });
    const auto count_others = [&](auto is_counted) {
      return static_cast<std::size_t>(
          std::count_if(kept_.begin(), kept_.end(),
                        [&](const Kept& kept) { return kept.owner != owner && is_counted(kept); }));
    };
    if (count_others([](const Kept&) { return true; }) >= kDepositsMax ||
        count_others([from](const Kept& kept) { return kept.from == from; }) >= kDepositsPerAddress)
      return failure("the server keeps as many keys as it can: try again in some minutes");
    const auto same = find(deposit.slot);
    if (same != kept_.end() && same->owner != owner)
      return failure("the code is in use: make another one");
    std::erase_if(kept_, [&owner](const Kept& kept) { return kept.owner == owner; });
    kept_.push_back({owner, from, now_us + kDepositUs, deposit.slot, std::move(deposit.sealed)});
    return {};
  }

  /// Removes the key of a slot and returns it, or returns nullopt if there is none. All slots are
  /// compared, each in full, so the time says nothing about those that are in use. Cost:
  /// O(deposits).
  std::optional<Bytes> take(const KeySlot& slot, TimeUs now_us) {
    const auto found = find(slot);
    if (found == kept_.end()) return std::nullopt;
    std::optional<Bytes> sealed;
    if (now_us < found->until_us) sealed = std::move(found->sealed);
    kept_.erase(found);
    return sealed;
  }

  std::size_t size() const { return kept_.size(); }

 private:
  struct Kept {
    PublicKey owner{};
    AddressBlock from{};
    TimeUs until_us = 0;
    KeySlot slot{};
    Bytes sealed;
  };
  std::vector<Kept>::iterator find(const KeySlot& slot) {
    auto found = kept_.end();
    for (auto at = kept_.begin(); at != kept_.end(); ++at) {
      if (is_same_slot(at->slot, slot)) found = at;
    }
    return found;
  }

  std::vector<Kept> kept_;
};

}  // namespace runstone
