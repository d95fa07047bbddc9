#include "common/rights/rights_state.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/rights/change_rules.hpp"
#include "tests/support/rights/random_rights.hpp"

namespace runstone::test {
namespace {

/// Keeps all records and answers each question by a walk from the newest to the oldest.
class RightsModel {
 public:
  void apply(const RightsChange& change, const ChangeOrigin& origin) {
    records_.push_back({change, origin});
  }
  const std::vector<RightsRecord>& records() const { return records_; }

  std::optional<Decided<Role>> role(const std::string& name) const {
    for (auto r = records_.rbegin(); r != records_.rend(); ++r) {
      if (const auto* define = std::get_if<DefineRole>(&r->change)) {
        if (define->role.name == name) return Decided<Role>{define->role, r->origin};
      }
      if (const auto* remove = std::get_if<RemoveRole>(&r->change)) {
        if (remove->role == name) return built_in(name, r->origin);
      }
    }
    return built_in(name, {});
  }
  std::string granted(const PublicKey& key) const {
    const std::string name = granted_by(key, records_.size());
    return role(name) ? name : "";
  }
  /// Returns the password that the first `count` records say.
  std::optional<JoinPassword> password_by(std::size_t count) const {
    while (count-- > 0) {
      const auto* change = std::get_if<SetPassword>(&records_[count].change);
      if (change != nullptr) return change->password;
    }
    return std::nullopt;
  }
  std::optional<JoinPassword> password() const { return password_by(records_.size()); }
  std::string default_role() const {
    for (auto r = records_.rbegin(); r != records_.rend(); ++r) {
      if (const auto* change = std::get_if<SetDefaultRole>(&r->change)) return change->role;
    }
    return "builder";
  }
  Role role_of(const PublicKey& key) const {
    const std::string name = granted(key).empty() ? default_role() : granted(key);
    return role(name) ? role(name)->value : role("visitor")->value;
  }
  /// Returns the record of the last restriction of a subject that was not lifted.
  const RightsRecord* restriction(RestrictionKind kind, const RestrictionSubject& subject) const {
    for (auto r = records_.rbegin(); r != records_.rend(); ++r) {
      if (const auto* c = std::get_if<Restrict>(&r->change)) {
        if (c->kind == kind && c->subject == subject) return &*r;
      }
      if (const auto* c = std::get_if<Lift>(&r->change)) {
        if (c->kind == kind && c->subject == subject) return nullptr;
      }
    }
    return nullptr;
  }
  std::map<std::string, Decided<ProtectedBox>> boxes() const {
    std::map<std::string, Decided<ProtectedBox>> boxes;
    for (const RightsRecord& r : records_) {
      if (const auto* c = std::get_if<Protect>(&r.change)) boxes[c->box.name] = {c->box, r.origin};
      if (const auto* c = std::get_if<Unprotect>(&r.change)) boxes.erase(c->box);
    }
    return boxes;
  }

 private:
  /// Returns the name that the first `count` records grant, whether there is such a role or not.
  std::string granted_by(const PublicKey& key, std::size_t count) const {
    while (count-- > 0) {
      const auto* grant = std::get_if<GrantRole>(&records_[count].change);
      if (grant != nullptr && grant->key == key) return grant->role;
      const auto* accept = std::get_if<AcceptPassword>(&records_[count].change);
      const auto password = password_by(count);
      if (accept == nullptr || accept->key != key || !password) continue;
      const std::string before = granted_by(key, count);
      return before.empty() ? password->role : before;
    }
    return "";
  }
  static std::optional<Decided<Role>> built_in(const std::string& name, const ChangeOrigin& by) {
    for (const Role& role : built_in_roles()) {
      if (role.name == name) return Decided<Role>{role, by};
    }
    return std::nullopt;
  }
  std::vector<RightsRecord> records_;
};

constexpr TimeUs kNow = 50;

bool holds_now(const RightsRecord* record) {
  if (record == nullptr) return false;
  const TimeUs until_us = std::get<Restrict>(record->change).until_us;
  return until_us == 0 || kNow < until_us;
}

void check_players(const RightsState& state, const RightsModel& model) {
  std::vector<PublicKey> administrators;
  for (std::uint8_t i = 0; i < kCloseKeys; ++i) {
    const PublicKey key = key_of(i);
    const Role role = model.role_of(key);
    REQUIRE(state.role_of(key) == role);
    for (const auto kind : {RestrictionKind::ban, RestrictionKind::mute, RestrictionKind::freeze}) {
      const RightsRecord* record = model.restriction(kind, key);
      const auto* found = state.restriction(kind, key, kNow);
      REQUIRE((found != nullptr) == holds_now(record));
      if (found != nullptr) REQUIRE(found->by == record->origin);
    }
    const bool is_banned = holds_now(model.restriction(RestrictionKind::ban, key));
    const bool is_muted = holds_now(model.restriction(RestrictionKind::mute, key));
    const bool is_frozen = holds_now(model.restriction(RestrictionKind::freeze, key));
    for (std::size_t r = 0; r < kRightCount; ++r) {
      const auto right = static_cast<Right>(r);
      const bool edits =
          right == Right::build || right == Right::build_protected || right == Right::undo;
      const bool expected = role.rights.has(right) && !is_banned &&
                            !(is_muted && right == Right::chat) && !(is_frozen && edits);
      REQUIRE(state.decide(key, right, kNow).is_allowed == expected);
    }
    if (role.rights.has(Right::administer) && !is_banned && state.grants().contains(key)) {
      administrators.push_back(key);
    }
  }
  REQUIRE(state.administrators(kNow) == administrators);
}

void check_addresses(const RightsState& state, const RightsModel& model, AddressBlock address) {
  const RightsRecord* longest = nullptr;
  unsigned longest_bits = 0;
  for (const RightsRecord& r : model.records()) {
    const auto* c = std::get_if<Restrict>(&r.change);
    const auto* range = c == nullptr ? nullptr : std::get_if<AddressRange>(&c->subject);
    if (range == nullptr || !range->contains(address)) continue;
    const RightsRecord* record = model.restriction(RestrictionKind::ban, *range);
    if (!holds_now(record) || (longest != nullptr && range->bits < longest_bits)) continue;
    longest = record;
    longest_bits = range->bits;
  }
  const auto* found = state.address_ban(address, kNow);
  REQUIRE((found != nullptr) == (longest != nullptr));
  if (found != nullptr) REQUIRE(found->by == longest->origin);
}

void check_boxes(const RightsState& state, const RightsModel& model, const VoxelBox& place) {
  const auto boxes = model.boxes();
  REQUIRE(state.boxes().size() == boxes.size());
  std::size_t overlapping = 0;
  for (const auto& [name, box] : boxes) {
    const auto* found = state.find_box(name);
    REQUIRE(found != nullptr);
    REQUIRE(found->value == box.value);
    REQUIRE(found->by == box.by);
    overlapping += intersect(box.value.box, place).empty() ? 0 : 1;
  }
  const auto listed = state.boxes_in(place);
  REQUIRE(listed.size() == overlapping);
  for (std::size_t i = 1; i < listed.size(); ++i) {
    const auto &a = *listed[i - 1], &b = *listed[i];
    const bool is_sorted = a.value.priority > b.value.priority ||
                           (a.value.priority == b.value.priority && a.by.seq > b.by.seq);
    REQUIRE(is_sorted);
  }
  const auto at = state.boxes_in({place.min, {place.min.x + 1, place.min.y + 1, place.min.z + 1}});
  REQUIRE(state.box_at(place.min) == (at.empty() ? nullptr : at.front()));
  for (std::uint8_t i = 0; i < kCloseKeys; ++i) {
    RightsState::Holding expected;
    for (const auto& [name, box] : boxes) {
      if (box.value.owner != key_of(i)) continue;
      ++expected.boxes;
      expected.volume += volume_of(box.value.box);
    }
    REQUIRE(state.holding_of(key_of(i)).boxes == expected.boxes);
    REQUIRE(state.holding_of(key_of(i)).volume == expected.volume);
  }
}

void check_inverse(const RightsModel& model, const RightsModel& before) {
  const RightsRecord& last = model.records().back();
  const auto inverse = inverse_of(model.records(), last.origin.seq);
  REQUIRE(inverse.has_value());
  REQUIRE(validate(*inverse).has_value());
  RightsModel after = model;
  after.apply(*inverse, {last.origin.seq + 1, 0, 0});
  for (std::uint8_t i = 0; i < kCloseKeys; ++i) {
    const PublicKey key = key_of(i);
    REQUIRE(after.role_of(key) == before.role_of(key));
    const auto* was = before.restriction(RestrictionKind::ban, key);
    const auto* is = after.restriction(RestrictionKind::ban, key);
    REQUIRE((was == nullptr) == (is == nullptr));
    if (is != nullptr) REQUIRE(is->change == was->change);
  }
  REQUIRE(after.default_role() == before.default_role());
  REQUIRE(after.password() == before.password());
  const auto boxes_before = before.boxes(), boxes_after = after.boxes();
  REQUIRE(boxes_after.size() == boxes_before.size());
  for (const auto& [name, box] : boxes_before) REQUIRE(boxes_after.at(name).value == box.value);
}

}  // namespace

TEST_CASE("a state says what its records say, read from the newest to the oldest",
          "[rights][property]") {
  SplitMix64 rng{66 + Catch::rngSeed()};
  for (int round = 0; round < 25; ++round) {
    RightsState state;
    RightsModel model;
    for (Sequence seq = 1; seq <= 80; ++seq) {
      CAPTURE(Catch::rngSeed(), round, seq);
      const RightsChange change = random_close_change(rng);
      const ChangeOrigin origin{seq, static_cast<AuthorId>(rng.below(9)), kNow};
      const RightsModel before = model;
      state.apply(change, origin);
      model.apply(change, origin);
      REQUIRE(state.password().value == model.password());
      check_players(state, model);
      check_addresses(state, model, AddressBlock{rng.below(3) * 0x0001'0001'0001'0001ULL});
      check_boxes(state, model, random_box_in(rng, kCloseWorld, 6));
      check_inverse(model, before);
    }
  }
}

TEST_CASE("only the newest record of a cell has an inverse", "[rights][property]") {
  SplitMix64 rng{67 + Catch::rngSeed()};
  for (int round = 0; round < 50; ++round) {
    std::vector<RightsRecord> records;
    for (Sequence seq = 1; seq <= 60; ++seq) {
      records.push_back({random_close_change(rng), {seq, 0, 0}});
    }
    // Equal states with and without the record mean that a later one has replaced it. The roles of
    // a player say nothing about it, so grants and boxes are compared.
    for (const RightsRecord& record : records) {
      CAPTURE(Catch::rngSeed(), round, record.origin.seq);
      RightsState with;
      for (const RightsRecord& r : records) with.apply(r.change, r.origin);
      bool decides = false;
      if (const auto* grant = std::get_if<GrantRole>(&record.change)) {
        const auto found = with.grants().find(grant->key);
        const auto accepts_later = [&](const RightsRecord& later) {
          const auto* accept = std::get_if<AcceptPassword>(&later.change);
          return accept != nullptr && accept->key == grant->key &&
                 later.origin.seq > record.origin.seq;
        };
        // No server writes a password that is accepted by somebody who has a role.
        const bool is_unreal = std::any_of(records.begin(), records.end(), accepts_later);
        if (grant->role.empty() || is_unreal) continue;
        decides = found != with.grants().end() && found->second.by == record.origin;
      } else if (const auto* protect = std::get_if<Protect>(&record.change)) {
        const auto* box = with.find_box(protect->box.name);
        decides = box != nullptr && box->by == record.origin;
      } else {
        continue;
      }
      REQUIRE(inverse_of(records, record.origin.seq).has_value() == decides);
    }
    REQUIRE_FALSE(inverse_of(records, 61).has_value());
  }
}

}  // namespace runstone::test
