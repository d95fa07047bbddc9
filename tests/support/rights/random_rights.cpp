#include "tests/support/rights/random_rights.hpp"

#include <algorithm>
#include <set>

namespace runstone::test {
namespace {

constexpr VoxelBox kWholeWorld = {{-kWorldLimit, -kWorldLimit, -kWorldLimit},
                                  {kWorldLimit, kWorldLimit, kWorldLimit}};

std::uint64_t any_number(SplitMix64& rng) { return rng.next() >> rng.below(64); }

PublicKey any_key(SplitMix64& rng) {
  PublicKey key;
  for (auto& byte : key) byte = static_cast<std::uint8_t>(rng.next());
  return key;
}

std::string any_rights_name(SplitMix64& rng) {
  static constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789_-.";
  std::string name(1 + rng.below(kRightsNameBytesMax), 'a');
  for (char& c : name) c = kLetters[rng.below(static_cast<std::uint32_t>(kLetters.size()))];
  return name;
}

std::string any_reason(SplitMix64& rng) {
  static constexpr const char* kPieces[] = {"a", " ", "\"", "\xc3\xa9", "\xf0\x9f\xa7\xb1"};
  std::string reason;
  const std::size_t bytes = rng.below(kReasonBytesMax - 3);
  while (reason.size() < bytes) reason += kPieces[rng.below(5)];
  return reason;
}

RestrictionSubject any_subject(SplitMix64& rng, RestrictionKind kind) {
  if (kind != RestrictionKind::ban || rng.below(2) == 0) return any_key(rng);
  const auto bits = static_cast<std::uint8_t>(rng.below(65));
  const std::uint64_t mask = bits == 0 ? 0 : ~std::uint64_t{0} << (64 - bits);
  return AddressRange{AddressBlock{rng.next() & mask}, bits};
}

Role any_role(SplitMix64& rng) {
  return {any_rights_name(rng),
          RightSet::of_bits(static_cast<std::uint32_t>(rng.next()) & RightSet::all().bits()),
          any_number(rng), static_cast<std::uint32_t>(any_number(rng)), any_number(rng)};
}

std::optional<JoinPassword> any_password(SplitMix64& rng, const std::string& role) {
  if (rng.below(4) == 0) return std::nullopt;
  JoinPassword password{role, {}, {}};
  for (auto& byte : password.salt) byte = static_cast<std::uint8_t>(rng.next());
  for (auto& byte : password.hash) byte = static_cast<std::uint8_t>(rng.next());
  return password;
}

ProtectedBox any_protected_box(SplitMix64& rng) {
  ProtectedBox box;
  box.name = any_rights_name(rng);
  box.box = random_box_in(rng, kWholeWorld, std::int32_t{1} << rng.between(0, 30));
  box.priority = rng.between(-kBoxPriorityMax, kBoxPriorityMax);
  if (rng.below(2) == 0) box.owner = any_key(rng);
  std::set<PublicKey> members;
  for (auto left = rng.below(4) * rng.below(20); left > 0; --left) members.insert(any_key(rng));
  box.members.assign(members.begin(), members.end());
  std::set<std::string> roles;
  for (auto left = rng.below(kBoxRolesMax + 1); left > 0; --left)
    roles.insert(any_rights_name(rng));
  box.roles.assign(roles.begin(), roles.end());
  return box;
}

PublicKey close_key(SplitMix64& rng) {
  return key_of(static_cast<std::uint8_t>(rng.below(kCloseKeys)));
}

std::string close_box_name(SplitMix64& rng) { return "box-" + std::to_string(rng.below(9)); }

RestrictionSubject close_subject(SplitMix64& rng, RestrictionKind kind) {
  if (kind != RestrictionKind::ban || rng.below(2) == 0) return close_key(rng);
  const auto bits = static_cast<std::uint8_t>(rng.below(5) * 16);
  const std::uint64_t mask = bits == 0 ? 0 : ~std::uint64_t{0} << (64 - bits);
  return AddressRange{AddressBlock{(std::uint64_t{rng.below(3)} * 0x0001'0001'0001'0001) & mask},
                      bits};
}

RestrictionKind any_kind(SplitMix64& rng) { return static_cast<RestrictionKind>(rng.below(3)); }

}  // namespace

VoxelBox random_box_in(SplitMix64& rng, const VoxelBox& world, std::int32_t side_max) {
  const auto range = [&](std::int32_t low, std::int32_t high) {
    const std::int32_t side = rng.between(1, std::min(side_max, high - low));
    const std::int32_t min = rng.between(low, high - side);
    return std::pair(min, min + side);
  };
  const auto [x0, x1] = range(world.min.x, world.max.x);
  const auto [y0, y1] = range(world.min.y, world.max.y);
  const auto [z0, z1] = range(world.min.z, world.max.z);
  return {{x0, y0, z0}, {x1, y1, z1}};
}

RightsChange random_rights_change(SplitMix64& rng) {
  const RestrictionKind kind = any_kind(rng);
  switch (rng.below(14)) {
    case 0:
      return DefineRole{any_role(rng)};
    case 11:
      return SetPassword{any_password(rng, any_rights_name(rng))};
    case 12:
      return AcceptPassword{any_key(rng)};
    case 13: {
      const auto step_us = static_cast<TimeUs>(any_number(rng));
      return CorrectTime{step_us == 0 ? -1 : step_us,
                         std::max<Sequence>(1, any_number(rng) & kSequenceMax)};
    }
    case 8:
      return CreateInvite{{rng.next(), any_rights_name(rng), 1 + rng.below(kInviteUsesMax),
                           std::max<TimeUs>(1, static_cast<TimeUs>(any_number(rng) >> 1))}};
    case 9:
      return AcceptInvite{rng.next(), any_key(rng)};
    case 10:
      return CancelInvite{rng.next()};
    case 1:
      return RemoveRole{any_rights_name(rng)};
    case 2:
      if (rng.below(4) == 0)
        return GrantRole{any_key(rng), any_rights_name(rng),
                         std::max<TimeUs>(1, static_cast<TimeUs>(any_number(rng) >> 1))};
      return GrantRole{any_key(rng), rng.below(4) == 0 ? "" : any_rights_name(rng)};
    case 3:
      return SetDefaultRole{any_rights_name(rng)};
    case 4:
      return Restrict{kind, any_subject(rng, kind), static_cast<TimeUs>(any_number(rng) >> 1),
                      any_reason(rng)};
    case 5:
      return Lift{kind, any_subject(rng, kind)};
    case 6:
      return Protect{any_protected_box(rng)};
    default:
      return Unprotect{any_rights_name(rng)};
  }
}

std::string random_close_role(SplitMix64& rng) {
  static constexpr const char* kNames[] = {"visitor", "builder", "moderator", "administrator",
                                           "mason",   "guest",   "smith"};
  return kNames[rng.below(7)];
}

ProtectedBox random_close_box(SplitMix64& rng) {
  ProtectedBox box;
  box.name = close_box_name(rng);
  box.box = random_box_in(rng, kCloseWorld, rng.below(3) == 0 ? 12 : 5);
  box.priority = rng.between(-1, 1);
  if (rng.below(2) == 0) box.owner = close_key(rng);
  std::set<PublicKey> members;
  for (auto left = rng.below(4); left > 0; --left) members.insert(close_key(rng));
  box.members.assign(members.begin(), members.end());
  if (rng.below(4) == 0) box.roles = {random_close_role(rng)};
  return box;
}

RightsChange random_close_change(SplitMix64& rng) {
  const RestrictionKind kind = any_kind(rng);
  switch (rng.below(13)) {
    case 10:
      return SetPassword{any_password(rng, random_close_role(rng))};
    case 11:
    case 12:
      return AcceptPassword{close_key(rng)};
    case 0: {
      Role role = any_role(rng);
      role.name = random_close_role(rng);
      return DefineRole{role};
    }
    case 1:
      return RemoveRole{random_close_role(rng)};
    case 2:
      return GrantRole{close_key(rng), rng.below(4) == 0 ? "" : random_close_role(rng)};
    case 3:
      return SetDefaultRole{random_close_role(rng)};
    case 4:
    case 5:
      return Restrict{kind, close_subject(rng, kind), static_cast<TimeUs>(rng.below(100)),
                      any_reason(rng)};
    case 6:
      return Lift{kind, close_subject(rng, kind)};
    case 7:
    case 8:
      return Protect{random_close_box(rng)};
    default:
      return Unprotect{close_box_name(rng)};
  }
}

}  // namespace runstone::test
