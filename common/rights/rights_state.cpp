#include "common/rights/rights_state.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

bool holds(const Decided<Restrict>& restriction, TimeUs now_us) {
  const TimeUs until_us = restriction.value.until_us;
  return until_us == 0 || now_us < until_us;
}

/// Returns an end that steps with the time. Requires that it is above 0. An end of 0 would be none.
TimeUs moved_end(TimeUs until_us, TimeUs step_us) {
  constexpr TimeUs kEndMax = std::numeric_limits<TimeUs>::max();
  if (step_us > kEndMax - until_us) return kEndMax;
  return std::max<TimeUs>(1, until_us + step_us);
}

BoxRank rank_of(const Decided<ProtectedBox>& box) {
  return {box.value.priority, box.by.seq, box.value.name};
}
bool decides_first(const Decided<ProtectedBox>& a, const Decided<ProtectedBox>& b) {
  return decides_before(rank_of(a), rank_of(b));
}

AddressRange range_around(AddressBlock address, unsigned bits) {
  const auto block = static_cast<std::uint64_t>(address);
  const std::uint64_t mask = bits == 0 ? 0 : ~std::uint64_t{0} << (64 - bits);
  return {AddressBlock{block & mask}, static_cast<std::uint8_t>(bits)};
}

}  // namespace

RightsState::RightsState() : default_role_{kBuilderRole, {}} {
  for (const Role& role : built_in_roles()) roles_[role.name] = {role, {}};
}

void RightsState::apply(const RightsChange& change, const ChangeOrigin& origin) {
  time_us_ = origin.time_us;
  std::visit([&](const auto& kind) { apply_kind(kind, origin); }, change);
}

void RightsState::apply_kind(const DefineRole& change, const ChangeOrigin& origin) {
  roles_[change.role.name] = {change.role, origin};
}

void RightsState::apply_kind(const RemoveRole& change, const ChangeOrigin& origin) {
  for (const Role& role : built_in_roles()) {
    if (role.name != change.role) continue;
    roles_[role.name] = {role, origin};
    return;
  }
  roles_.erase(change.role);
}

void RightsState::apply_kind(const GrantRole& change, const ChangeOrigin& origin) {
  if (change.until_us != 0) {
    std::erase_if(timed_grants_,
                  [&](const auto& entry) { return entry.second.value.until_us <= origin.time_us; });
    timed_grants_[change.key] = {change, origin};
    has_ever_granted_ = has_timed_grants_ever_ = true;
    return;
  }
  timed_grants_.erase(change.key);
  if (change.role.empty()) {
    grants_.erase(change.key);
  } else {
    grants_[change.key] = {change.role, origin};
    has_ever_granted_ = true;
  }
}

void RightsState::apply_kind(const SetDefaultRole& change, const ChangeOrigin& origin) {
  default_role_ = {change.role, origin};
}

void RightsState::apply_kind(const Restrict& change, const ChangeOrigin& origin) {
  if (const auto* key = std::get_if<PublicKey>(&change.subject)) {
    by_key_[{*key, change.kind}] = {change, origin};
    return;
  }
  const auto& range = std::get<AddressRange>(change.subject);
  const bool is_new =
      address_bans_.insert_or_assign(range, Decided<Restrict>{change, origin}).second;
  if (is_new) ++bans_of_length_[range.bits];
}

void RightsState::apply_kind(const Lift& change, const ChangeOrigin&) {
  if (const auto* key = std::get_if<PublicKey>(&change.subject)) {
    by_key_.erase({*key, change.kind});
    return;
  }
  const auto& range = std::get<AddressRange>(change.subject);
  if (address_bans_.erase(range) != 0) --bans_of_length_[range.bits];
}

void RightsState::apply_kind(const Protect& change, const ChangeOrigin& origin) {
  const ProtectedBox& box = change.box;
  remove_box(box.name);
  const Decided<ProtectedBox>& added = boxes_[box.name] = {box, origin};
  if (free_ids_.empty()) {
    free_ids_.push_back(static_cast<BoxIndex::Id>(indexed_.size()));
    indexed_.push_back(nullptr);
  }
  const BoxIndex::Id id = free_ids_.back();
  free_ids_.pop_back();
  indexed_[id] = &added;
  id_of_[box.name] = id;
  index_.insert(id, box.box);
  if (box.owner) owned_.emplace(*box.owner, id);
}

void RightsState::apply_kind(const Unprotect& change, const ChangeOrigin&) {
  remove_box(change.box);
}

void RightsState::apply_kind(const CreateInvite& change, const ChangeOrigin& origin) {
  has_ever_granted_ = true;
  std::erase_if(invites_, [&](const auto& entry) {
    const OpenInvite& old = entry.second.value;
    return old.invite.until_us <= origin.time_us || old.accepted >= old.invite.uses;
  });
  invites_[change.invite.id] = {{change.invite, 0}, origin};
}

void RightsState::apply_kind(const AcceptInvite& change, const ChangeOrigin& origin) {
  const auto* usable = usable_invite(change.invite, origin.time_us);
  if (usable == nullptr || grants_.contains(change.key)) return;
  grants_[change.key] = {usable->value.invite.role, origin};
  ++invites_.at(change.invite).value.accepted;
}

void RightsState::apply_kind(const CancelInvite& change, const ChangeOrigin& /*origin*/) {
  invites_.erase(change.invite);
}

void RightsState::apply_kind(const SetPassword& change, const ChangeOrigin& origin) {
  password_ = {change.password, origin};
}

void RightsState::apply_kind(const AcceptPassword& change, const ChangeOrigin& origin) {
  if (!password_.value || grants_.contains(change.key)) return;
  grants_[change.key] = {password_.value->role, origin};
}

const ChangeOrigin& RightsState::giver_of_end(const ChangeOrigin& by) const {
  const auto moved = moved_ends_.find(by.seq);
  return moved == moved_ends_.end() ? by : moved->second;
}

void RightsState::apply_kind(const CorrectTime& change, const ChangeOrigin& origin) {
  std::map<Sequence, ChangeOrigin> moved_ends;
  const auto correct = [&](const ChangeOrigin& by, TimeUs& until_us) {
    const ChangeOrigin& giver = giver_of_end(by);
    // A record with a later time than a correct one has its time from a wrong clock.
    const bool is_later = change.step_us < 0 && giver.time_us > origin.time_us;
    if (giver.seq >= change.since || is_later) {
      until_us = moved_end(until_us, change.step_us);
      moved_ends[by.seq] = origin;
    } else if (giver.seq != by.seq) {
      moved_ends[by.seq] = giver;
    }
  };
  const auto correct_restriction = [&](Decided<Restrict>& restriction) {
    if (restriction.value.until_us != 0) correct(restriction.by, restriction.value.until_us);
  };
  for (auto& [subject, restriction] : by_key_) correct_restriction(restriction);
  for (auto& [range, ban] : address_bans_) correct_restriction(ban);
  for (auto& [id, invite] : invites_) correct(invite.by, invite.value.invite.until_us);
  for (auto& [key, grant] : timed_grants_) correct(grant.by, grant.value.until_us);
  moved_ends_ = std::move(moved_ends);
  is_time_corrected_ = true;
}

bool RightsState::has_ends_given_since(Sequence since, TimeUs now_us) const {
  const auto is_meant = [&](const ChangeOrigin& by, TimeUs until_us) {
    return until_us > now_us && giver_of_end(by).seq >= since;
  };
  const auto is_meant_restriction = [&](const auto& entry) {
    const Decided<Restrict>& restriction = entry.second;
    return restriction.value.until_us != 0 && is_meant(restriction.by, restriction.value.until_us);
  };
  return std::any_of(by_key_.begin(), by_key_.end(), is_meant_restriction) ||
         std::any_of(address_bans_.begin(), address_bans_.end(), is_meant_restriction) ||
         std::any_of(invites_.begin(), invites_.end(),
                     [&](const auto& entry) {
                       return is_meant(entry.second.by, entry.second.value.invite.until_us);
                     }) ||
         std::any_of(timed_grants_.begin(), timed_grants_.end(), [&](const auto& entry) {
           return is_meant(entry.second.by, entry.second.value.until_us);
         });
}

const Decided<OpenInvite>* RightsState::usable_invite(InviteId id, TimeUs now_us) const {
  const auto found = invites_.find(id);
  if (found == invites_.end()) return nullptr;
  const OpenInvite& open = found->second.value;
  const bool is_usable = now_us < open.invite.until_us && open.accepted < open.invite.uses;
  return is_usable ? &found->second : nullptr;
}

void RightsState::remove_box(const std::string& name) {
  const auto found = id_of_.find(name);
  if (found == id_of_.end()) return;
  const BoxIndex::Id id = found->second;
  const auto box = boxes_.find(name);
  if (box->second.value.owner) owned_.erase({*box->second.value.owner, id});
  index_.remove(id);
  indexed_[id] = nullptr;
  free_ids_.push_back(id);
  id_of_.erase(found);
  boxes_.erase(box);
}

const Decided<Role>* RightsState::find_role(const std::string& name) const {
  const auto found = roles_.find(name);
  return found == roles_.end() ? nullptr : &found->second;
}

const Decided<GrantRole>* RightsState::timed_grant(const PublicKey& key, TimeUs now_us) const {
  const auto found = timed_grants_.find(key);
  const bool counts = found != timed_grants_.end() && now_us < found->second.value.until_us &&
                      find_role(found->second.value.role) != nullptr;
  return counts ? &found->second : nullptr;
}

std::vector<GrantRole> RightsState::grants_ended(TimeUs since_us, TimeUs now_us) const {
  std::vector<GrantRole> ended;
  for (const auto& [key, grant] : timed_grants_) {
    const TimeUs until_us = grant.value.until_us;
    if (since_us < until_us && until_us <= now_us) ended.push_back(grant.value);
  }
  return ended;
}

RightsState::Granted RightsState::granted_at(const PublicKey& key, TimeUs now_us) const {
  if (const auto* timed = timed_grant(key, now_us))
    return {&find_role(timed->value.role)->value, timed->by};
  const auto found = grants_.find(key);
  if (found == grants_.end()) return {};
  const Decided<Role>* role = find_role(found->second.value);
  return role == nullptr ? Granted{} : Granted{&role->value, found->second.by};
}

const Role& RightsState::role_of(const PublicKey& key, TimeUs now_us) const {
  if (const Granted granted = granted_at(key, now_us); granted.role != nullptr)
    return *granted.role;
  const Decided<Role>* role = find_role(default_role_.value);
  if (role == nullptr) role = find_role(kVisitorRole);
  RUNSTONE_ASSERT(role != nullptr);
  return role->value;
}

std::vector<PublicKey> RightsState::administrators(TimeUs now_us) const {
  std::vector<PublicKey> keys;
  for (const auto& [key, grant] : grants_) {
    if (!role_of(key, now_us).rights.has(Right::administer)) continue;
    if (restriction(RestrictionKind::ban, key, now_us) == nullptr) keys.push_back(key);
  }
  return keys;
}

const Decided<Restrict>* RightsState::restriction(RestrictionKind kind, const PublicKey& key,
                                                  TimeUs now_us) const {
  const auto found = by_key_.find({key, kind});
  const bool counts = found != by_key_.end() && holds(found->second, now_us);
  return counts ? &found->second : nullptr;
}

const Decided<Restrict>* RightsState::address_ban(AddressBlock address, TimeUs now_us) const {
  for (unsigned length = 65; length-- > 0;) {
    if (bans_of_length_[length] == 0) continue;
    const auto found = address_bans_.find(range_around(address, length));
    if (found != address_bans_.end() && holds(found->second, now_us)) return &found->second;
  }
  return nullptr;
}

const Decided<Restrict>* RightsState::find_restriction(RestrictionKind kind,
                                                       const RestrictionSubject& subject) const {
  if (const auto* key = std::get_if<PublicKey>(&subject)) {
    const auto found = by_key_.find({*key, kind});
    return found == by_key_.end() ? nullptr : &found->second;
  }
  const auto found = address_bans_.find(std::get<AddressRange>(subject));
  return found == address_bans_.end() ? nullptr : &found->second;
}

std::vector<const Decided<Restrict>*> RightsState::restrictions() const {
  std::vector<const Decided<Restrict>*> all;
  all.reserve(restriction_count());
  for (const auto& [subject, restriction] : by_key_) all.push_back(&restriction);
  for (const auto& [range, ban] : address_bans_) all.push_back(&ban);
  return all;
}

const Decided<ProtectedBox>* RightsState::find_box(const std::string& name) const {
  const auto found = boxes_.find(name);
  return found == boxes_.end() ? nullptr : &found->second;
}

std::vector<const Decided<ProtectedBox>*> RightsState::boxes_in(const VoxelBox& box) const {
  std::vector<const Decided<ProtectedBox>*> found;
  if (box.empty()) return found;
  index_.visit_overlapping(box, [&](BoxIndex::Id id) {
    found.push_back(indexed_[id]);
    return true;
  });
  std::sort(found.begin(), found.end(),
            [](const auto* a, const auto* b) { return decides_first(*a, *b); });
  return found;
}

std::vector<const Decided<ProtectedBox>*> RightsState::some_boxes_in(const VoxelBox& box,
                                                                     std::size_t count_max) const {
  std::vector<const Decided<ProtectedBox>*> found;
  index_.visit_overlapping(box, [&](BoxIndex::Id id) {
    if (found.size() == count_max) return false;
    found.push_back(indexed_[id]);
    return true;
  });
  return found;
}

const Decided<ProtectedBox>* RightsState::box_at(VoxelPos at) const {
  const Decided<ProtectedBox>* first = nullptr;
  index_.visit_overlapping({at, {at.x + 1, at.y + 1, at.z + 1}}, [&](BoxIndex::Id id) {
    if (first == nullptr || decides_first(*indexed_[id], *first)) first = indexed_[id];
    return true;
  });
  return first;
}

std::vector<const Decided<ProtectedBox>*> RightsState::boxes_of(const PublicKey& owner) const {
  std::vector<const Decided<ProtectedBox>*> found;
  for (auto at = owned_.lower_bound({owner, 0}); at != owned_.end() && at->first == owner; ++at)
    found.push_back(indexed_[at->second]);
  return found;
}

RightsState::Holding RightsState::holding_of(const PublicKey& owner,
                                             const ProtectedBox* except) const {
  Holding holding;
  for (auto at = owned_.lower_bound({owner, 0}); at != owned_.end() && at->first == owner; ++at) {
    const ProtectedBox& box = indexed_[at->second]->value;
    if (except != nullptr && box.name == except->name) continue;
    const std::uint64_t volume = volume_of(box.box);
    ++holding.boxes;
    holding.volume = volume > UINT64_MAX - holding.volume ? UINT64_MAX : holding.volume + volume;
  }
  return holding;
}

}  // namespace runstone
