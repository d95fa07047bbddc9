// NameClaims: the names that keys own in this world, by their folded form, and which of the claims
// are on disk. A claim counts from the moment when the world strand makes it. It is durable before
// the player hears of it: the session is accepted when names_durable() covers the claim. So a crash
// either finds the claim on disk, or nobody was accepted under it.
// Memory: about 300 bytes a claim, at most kNameClaimsMax of them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/world/environment/player_rows.hpp"

namespace runstone {

/// Further names are not claimed. Their players play without owning them.
inline constexpr std::size_t kNameClaimsMax = 100'000;

class NameClaims {
 public:
  /// Adds a claim of the store.
  void restore(NameClaim claim) { insert(std::move(claim), 0); }

  /// Returns the claim of a folded name, or null if nobody owns it. Cost: O(log claims).
  const NameClaim* find(const std::string& folded) const {
    const auto found = by_folded_.find(folded);
    return found == by_folded_.end() ? nullptr : &found->second.claim;
  }
  /// Returns the names of a key, ascending by folded form.
  std::vector<std::string> names_of(const PublicKey& key) const {
    std::vector<std::string> names;
    if (const auto found = by_key_.find(key); found != by_key_.end()) {
      for (const std::string& folded : found->second)
        names.push_back(by_folded_.at(folded).claim.name);
    }
    return names;
  }
  /// Adds a claim and returns the change to write. Requires that nobody owns the name.
  NameChange claim(NameClaim claim) {
    NameChange change{claim, false};
    insert(std::move(claim), ++queued_);
    return change;
  }
  /// Removes a claim and returns the change to write, or nullopt if nobody owns the name.
  std::optional<NameChange> release(const std::string& folded) {
    auto claim = remove(folded);
    if (!claim) return std::nullopt;
    ++queued_;
    return NameChange{*std::move(claim), true};
  }
  /// Makes these the claims. All of them are on disk.
  void restore_all(const std::vector<NameClaim>& claims) {
    by_folded_.clear();
    by_key_.clear();
    for (const NameClaim& claim : claims) restore(claim);
  }
  /// Applies a change that another server has written already.
  void apply(const NameChange& change) {
    remove(change.claim.folded);
    if (!change.is_release) restore(change.claim);
  }

  /// Reports that `count` more changes are on disk, the oldest first.
  void names_durable(std::size_t count) { durable_ += count; }
  /// Returns the number of the last change of this run. The first one has the number 1.
  std::uint64_t last_change() const { return queued_; }
  /// Returns the number of the last change that is on disk, with all before it.
  std::uint64_t durable_change() const { return durable_; }
  /// Returns true if the claim of this name is on disk. Requires that somebody owns it.
  bool is_durable(const std::string& folded) const {
    return by_folded_.at(folded).number <= durable_;
  }

  std::size_t size() const { return by_folded_.size(); }
  /// Returns all claims, ascending by folded form.
  std::vector<NameClaim> all() const {
    std::vector<NameClaim> claims;
    claims.reserve(size());
    for (const auto& [folded, entry] : by_folded_) claims.push_back(entry.claim);
    return claims;
  }

 private:
  /// Removes the claim of a name and returns it, or nullopt if nobody owns the name.
  std::optional<NameClaim> remove(const std::string& folded) {
    const auto found = by_folded_.find(folded);
    if (found == by_folded_.end()) return std::nullopt;
    NameClaim claim = std::move(found->second.claim);
    const auto names = by_key_.find(claim.key);
    names->second.erase(folded);
    if (names->second.empty()) by_key_.erase(names);
    by_folded_.erase(found);
    return claim;
  }
  struct Entry {
    NameClaim claim;
    std::uint64_t number = 0;  // of the change that made it; 0: it was on disk at the start
  };
  void insert(NameClaim claim, std::uint64_t number) {
    by_key_[claim.key].insert(claim.folded);
    std::string folded = claim.folded;
    by_folded_[std::move(folded)] = {std::move(claim), number};
  }

  std::map<std::string, Entry> by_folded_;
  std::map<PublicKey, std::set<std::string>> by_key_;
  std::uint64_t queued_ = 0, durable_ = 0;  // changes of this run
};

}  // namespace runstone
