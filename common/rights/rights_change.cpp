#include "common/rights/rights_change.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"

namespace runstone {
namespace {

// The tag of a change is its index in the variant, plus 1. A role with quotas of its own has a tag of
// its own, because the bytes of define_role have no room for them. The tags behind it are the index
// plus 2.
enum class ChangeTag : std::uint8_t {
  define_role = 1,
  remove_role = 2,
  grant_role = 3,
  set_default_role = 4,
  restrict = 5,
  lift = 6,
  protect = 7,
  unprotect = 8,
  create_invite = 9,
  accept_invite = 10,
  cancel_invite = 11,
  set_password = 12,
  accept_password = 13,
  define_role_with_quotas = 14,
  correct_time = 15,
  grant_role_until = 16  // a GrantRole with an end
};
static_assert(std::variant_size_v<RightsChange> + 1 ==
              static_cast<std::uint8_t>(ChangeTag::correct_time));

ChangeTag tag_of(const RightsChange& change) {
  const auto* define = std::get_if<DefineRole>(&change);
  if (define != nullptr && define->role.has_quotas()) return ChangeTag::define_role_with_quotas;
  if (std::holds_alternative<CorrectTime>(change)) return ChangeTag::correct_time;
  if (is_timed_grant(change)) return ChangeTag::grant_role_until;
  return static_cast<ChangeTag>(change.index() + 1);
}

// The tags of the subject of a restriction.
constexpr std::uint8_t kSubjectKey = 0;
constexpr std::uint8_t kSubjectRange = 1;

// A coordinate or a side has at most 5 bytes, a priority 2. Tag, counts and flags have one each.
constexpr std::size_t kNameBytesMax = 1 + kRightsNameBytesMax;
static_assert(kBoxMembersMax < 128 && kBoxRolesMax < 128 && kRightsNameBytesMax < 128);
static_assert(1 + kNameBytesMax + 6 * 5 + 2 + 1 + kPublicKeyBytes +
                  (1 + kBoxMembersMax * kPublicKeyBytes) + (1 + kBoxRolesMax * kNameBytesMax) <=
              kRightsChangeBytesMax);
// Tag, kind, subject, an end of at most 9 bytes, and the reason.
static_assert(1 + 1 + 1 + kPublicKeyBytes + 9 + 2 + kReasonBytesMax <= kRightsChangeBytesMax);

Result<void> check_name(std::string_view name, const char* what) {
  if (!is_rights_name(name)) return fail(ErrorCode::bad_value, what);
  return {};
}

Result<void> check_subject(RestrictionKind kind, const RestrictionSubject& subject) {
  if (kind > RestrictionKind::freeze) return fail(ErrorCode::bad_value, "unknown restriction");
  const auto* range = std::get_if<AddressRange>(&subject);
  if (range == nullptr) return {};
  if (kind != RestrictionKind::ban) {
    return fail(ErrorCode::bad_value, "a restriction of addresses that is no ban");
  }
  if (!range->is_canonical()) {
    return fail(ErrorCode::not_canonical, "address range with bits behind its prefix");
  }
  return {};
}

Result<void> check_box(const VoxelBox& box) {
  if (box.empty()) return fail(ErrorCode::bad_value, "box is empty");
  for (const std::int32_t c : {box.min.x, box.min.y, box.min.z}) {
    if (c < -kWorldLimit) return fail(ErrorCode::bad_value, "box reaches outside the world");
  }
  for (const std::int32_t c : {box.max.x, box.max.y, box.max.z}) {
    if (c > kWorldLimit) return fail(ErrorCode::bad_value, "box reaches outside the world");
  }
  return {};
}

/// Returns true if each item is greater than the one before it.
template <class T>
bool is_ascending(const std::vector<T>& items) {
  return std::adjacent_find(items.begin(), items.end(), std::greater_equal<>{}) == items.end();
}

Result<void> check_change(const DefineRole& change) {
  if (!RightSet::all().includes(change.role.rights)) {
    return fail(ErrorCode::bad_value, "role with an unknown right");
  }
  const Budget& edits = change.role.edit_budget;
  if (edits.per_second > kBudgetPerSecondMax || edits.burst > kBudgetBurstMax ||
      (edits.per_second == 0) != (edits.burst == 0)) {
    return fail(ErrorCode::bad_value, "edit budget of a role out of range");
  }
  if (change.role.chunk_loads_per_second > kBudgetPerSecondMax) {
    return fail(ErrorCode::bad_value, "chunk loads of a role out of range");
  }
  return check_name(change.role.name, "bad name of a role");
}

Result<void> check_change(const RemoveRole& change) {
  return check_name(change.role, "bad name of a role");
}

Result<void> check_change(const GrantRole& change) {
  if (change.until_us < 0) return fail(ErrorCode::bad_value, "grant ends before 1970");
  if (change.role.empty() && change.until_us != 0)
    return fail(ErrorCode::bad_value, "grant of the default role with an end");
  if (change.role.empty()) return {};
  return check_name(change.role, "bad name of a role");
}

Result<void> check_change(const SetDefaultRole& change) {
  return check_name(change.role, "bad name of a role");
}

Result<void> check_change(const Restrict& change) {
  if (change.until_us < 0) return fail(ErrorCode::bad_value, "restriction ends before 1970");
  if (change.reason.size() > kReasonBytesMax) {
    return fail(ErrorCode::limit_exceeded, "reason too long");
  }
  if (!is_printable_utf8(change.reason)) {
    return fail(ErrorCode::bad_value, "reason is not printable UTF-8");
  }
  return check_subject(change.kind, change.subject);
}

Result<void> check_change(const Lift& change) { return check_subject(change.kind, change.subject); }

Result<void> check_change(const Protect& change) {
  const ProtectedBox& box = change.box;
  if (const auto name = check_name(box.name, "bad name of a box"); !name) return name;
  if (const auto place = check_box(box.box); !place) return place;
  if (box.priority < -kBoxPriorityMax || box.priority > kBoxPriorityMax) {
    return fail(ErrorCode::bad_value, "priority out of range");
  }
  if (box.members.size() > kBoxMembersMax) {
    return fail(ErrorCode::limit_exceeded, "box with too many members");
  }
  if (box.roles.size() > kBoxRolesMax) {
    return fail(ErrorCode::limit_exceeded, "box with too many roles");
  }
  if (!is_ascending(box.members)) return fail(ErrorCode::not_canonical, "members not ascending");
  if (!is_ascending(box.roles)) return fail(ErrorCode::not_canonical, "roles not ascending");
  for (const std::string& role : box.roles) {
    if (const auto name = check_name(role, "bad name of a role"); !name) return name;
  }
  return {};
}

Result<void> check_change(const Unprotect& change) {
  return check_name(change.box, "bad name of a box");
}

Result<void> check_change(const CreateInvite& change) {
  const Invite& invite = change.invite;
  if (invite.uses == 0 || invite.uses > kInviteUsesMax)
    return fail(ErrorCode::bad_value, "uses of an invite out of range");
  if (invite.until_us <= 0) return fail(ErrorCode::bad_value, "invite ends before 1970");
  return check_name(invite.role, "bad name of a role");
}

Result<void> check_change(const AcceptInvite& /*change*/) { return {}; }
Result<void> check_change(const CancelInvite& /*change*/) { return {}; }

Result<void> check_change(const SetPassword& change) {
  if (!change.password) return {};
  return check_name(change.password->role, "bad name of a role");
}

Result<void> check_change(const AcceptPassword& /*change*/) { return {}; }

Result<void> check_change(const CorrectTime& change) {
  if (change.step_us == 0)
    return fail(ErrorCode::bad_value, "correction of the time without a step");
  if (change.since == 0 || change.since > kSequenceMax)
    return fail(ErrorCode::bad_value, "correction of the time since no record");
  return {};
}

void write_text(ByteWriter& w, std::string_view text) {
  w.varint(text.size());
  w.bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void write_subject(ByteWriter& w, RestrictionKind kind, const RestrictionSubject& subject) {
  w.u8(static_cast<std::uint8_t>(kind));
  if (const auto* key = std::get_if<PublicKey>(&subject)) {
    w.u8(kSubjectKey);
    w.bytes(*key);
    return;
  }
  const auto& range = std::get<AddressRange>(subject);
  w.u8(kSubjectRange);
  w.u64(static_cast<std::uint64_t>(range.first));
  w.u8(range.bits);
}

void write_change(ByteWriter& w, const DefineRole& change) {
  write_text(w, change.role.name);
  w.varint(change.role.rights.bits());
  w.varint(change.role.edit_volume_max);
  w.varint(change.role.claims_max);
  w.varint(change.role.claim_volume_max);
  if (!change.role.has_quotas()) return;
  w.varint(change.role.edit_budget.per_second);
  w.varint(change.role.edit_budget.burst);
  w.u8(change.role.view_radius_max);
  w.varint(change.role.chunk_loads_per_second);
}

void write_change(ByteWriter& w, const RemoveRole& change) { write_text(w, change.role); }

void write_change(ByteWriter& w, const GrantRole& change) {
  w.bytes(change.key);
  write_text(w, change.role);
  if (change.until_us != 0) w.varint(static_cast<std::uint64_t>(change.until_us));
}

void write_change(ByteWriter& w, const SetDefaultRole& change) { write_text(w, change.role); }

void write_change(ByteWriter& w, const Restrict& change) {
  write_subject(w, change.kind, change.subject);
  w.varint(static_cast<std::uint64_t>(change.until_us));
  write_text(w, change.reason);
}

void write_change(ByteWriter& w, const Lift& change) {
  write_subject(w, change.kind, change.subject);
}

void write_change(ByteWriter& w, const Protect& change) {
  const VoxelBox& box = change.box.box;
  write_text(w, change.box.name);
  w.svarint(box.min.x);
  w.svarint(box.min.y);
  w.svarint(box.min.z);
  w.varint(static_cast<std::uint64_t>(box.max.x - box.min.x - 1));
  w.varint(static_cast<std::uint64_t>(box.max.y - box.min.y - 1));
  w.varint(static_cast<std::uint64_t>(box.max.z - box.min.z - 1));
  w.svarint(change.box.priority);
  w.u8(change.box.owner ? 1 : 0);
  if (change.box.owner) w.bytes(*change.box.owner);
  w.varint(change.box.members.size());
  for (const PublicKey& member : change.box.members) w.bytes(member);
  w.varint(change.box.roles.size());
  for (const std::string& role : change.box.roles) write_text(w, role);
}

void write_change(ByteWriter& w, const Unprotect& change) { write_text(w, change.box); }

void write_change(ByteWriter& w, const CreateInvite& change) {
  w.u64(change.invite.id);
  write_text(w, change.invite.role);
  w.varint(change.invite.uses);
  w.varint(static_cast<std::uint64_t>(change.invite.until_us));
}

void write_change(ByteWriter& w, const AcceptInvite& change) {
  w.u64(change.invite);
  w.bytes(change.key);
}

void write_change(ByteWriter& w, const CancelInvite& change) { w.u64(change.invite); }

void write_change(ByteWriter& w, const SetPassword& change) {
  if (!change.password) return write_text(w, {});
  write_text(w, change.password->role);
  w.bytes(change.password->salt);
  w.bytes(change.password->hash);
}

void write_change(ByteWriter& w, const AcceptPassword& change) { w.bytes(change.key); }

void write_change(ByteWriter& w, const CorrectTime& change) {
  w.svarint(change.step_us);
  w.varint(change.since);
}

std::string read_text(ByteReader& r, std::size_t bytes_max, const char* what) {
  const ByteView text = r.bytes(static_cast<std::size_t>(r.varint_max(bytes_max, what)));
  return {text.begin(), text.end()};
}

std::string read_name(ByteReader& r) { return read_text(r, kRightsNameBytesMax, "name too long"); }

template <std::size_t N>
std::array<std::uint8_t, N> read_array(ByteReader& r) {
  std::array<std::uint8_t, N> out{};
  const ByteView bytes = r.bytes(N);
  std::copy(bytes.begin(), bytes.end(), out.begin());
  return out;
}

PublicKey read_key(ByteReader& r) { return read_array<kPublicKeyBytes>(r); }

RestrictionSubject read_subject(ByteReader& r) {
  const std::uint8_t form = r.u8();
  if (form == kSubjectKey) return read_key(r);
  if (form != kSubjectRange) r.reject(ErrorCode::unknown_kind, "unknown subject of a restriction");
  AddressRange range;
  range.first = static_cast<AddressBlock>(r.u64());
  range.bits = r.u8();
  return range;
}

Role read_role(ByteReader& r) {
  Role role;
  role.name = read_name(r);
  role.rights = RightSet::of_bits(static_cast<std::uint32_t>(
      r.varint_max(RightSet::all().bits(), "role with an unknown right")));
  role.edit_volume_max = r.varint();
  role.claims_max = static_cast<std::uint32_t>(
      r.varint_max(std::numeric_limits<std::uint32_t>::max(), "claims exceed 32 bits"));
  role.claim_volume_max = r.varint();
  return role;
}

Role read_role_with_quotas(ByteReader& r) {
  Role role = read_role(r);
  role.edit_budget.per_second = r.varint_max(kBudgetPerSecondMax, "edits of a role out of range");
  role.edit_budget.burst = r.varint_max(kBudgetBurstMax, "edits of a role out of range");
  role.view_radius_max = r.u8();
  role.chunk_loads_per_second = static_cast<std::uint32_t>(
      r.varint_max(kBudgetPerSecondMax, "chunk loads of a role out of range"));
  if (!role.has_quotas()) r.reject(ErrorCode::not_canonical, "quotas of a role that has none");
  return role;
}

TimeUs read_end_time(ByteReader& r) {
  constexpr auto kTimeMax = static_cast<std::uint64_t>(std::numeric_limits<TimeUs>::max());
  return static_cast<TimeUs>(r.varint_max(kTimeMax, "end too late"));
}

Invite read_invite(ByteReader& r) {
  Invite invite;
  invite.id = r.u64();
  invite.role = read_name(r);
  invite.uses =
      static_cast<std::uint32_t>(r.varint_max(kInviteUsesMax, "uses of an invite out of range"));
  invite.until_us = read_end_time(r);
  return invite;
}

SetPassword read_password(ByteReader& r) {
  JoinPassword password;
  password.role = read_name(r);
  if (password.role.empty()) return {};
  password.salt = read_array<kPasswordSaltBytes>(r);
  password.hash = read_array<kPasswordHashBytes>(r);
  return {std::move(password)};
}

Restrict read_restrict(ByteReader& r) {
  Restrict change;
  change.kind = static_cast<RestrictionKind>(r.u8());
  change.subject = read_subject(r);
  change.until_us = read_end_time(r);
  change.reason = read_text(r, kReasonBytesMax, "reason too long");
  return change;
}

/// Reads a side after the smallest coordinate. The result lies in the range of an i32: both are at
/// most 2^30 from 0.
std::int32_t read_end(ByteReader& r, std::int32_t min) {
  constexpr std::uint64_t kSideMax = 2 * std::uint64_t{kWorldLimit};
  return min + 1 + static_cast<std::int32_t>(r.varint_max(kSideMax - 1, "box side too long"));
}

VoxelBox read_protected_place(ByteReader& r) {
  const auto coordinate = [&r] {
    return static_cast<std::int32_t>(
        r.svarint_in(-kWorldLimit, kWorldLimit - 1, "coordinate outside the world"));
  };
  VoxelBox box;
  box.min.x = coordinate();
  box.min.y = coordinate();
  box.min.z = coordinate();
  box.max.x = read_end(r, box.min.x);
  box.max.y = read_end(r, box.min.y);
  box.max.z = read_end(r, box.min.z);
  return box;
}

ProtectedBox read_protected_box(ByteReader& r) {
  ProtectedBox box;
  box.name = read_name(r);
  box.box = read_protected_place(r);
  box.priority = static_cast<std::int32_t>(
      r.svarint_in(-kBoxPriorityMax, kBoxPriorityMax, "priority out of range"));
  const std::uint8_t has_owner = r.u8();
  if (has_owner > 1) r.reject(ErrorCode::bad_value, "flag of the owner is neither 0 nor 1");
  if (has_owner == 1) box.owner = read_key(r);
  const std::uint64_t members = r.varint_max(kBoxMembersMax, "box with too many members");
  for (std::uint64_t i = 0; i < members && r.ok(); ++i) box.members.push_back(read_key(r));
  const std::uint64_t roles = r.varint_max(kBoxRolesMax, "box with too many roles");
  for (std::uint64_t i = 0; i < roles && r.ok(); ++i) box.roles.push_back(read_name(r));
  return box;
}

RightsChange read_change_fields(ByteReader& r, ChangeTag tag) {
  switch (tag) {
    case ChangeTag::define_role:
      return DefineRole{read_role(r)};
    case ChangeTag::remove_role:
      return RemoveRole{read_name(r)};
    case ChangeTag::grant_role:
    case ChangeTag::grant_role_until: {
      GrantRole change{read_key(r), {}, 0};
      change.role = read_name(r);
      if (tag == ChangeTag::grant_role) return change;
      change.until_us = read_end_time(r);
      if (change.until_us == 0) r.reject(ErrorCode::not_canonical, "end of a grant that has none");
      return change;
    }
    case ChangeTag::set_default_role:
      return SetDefaultRole{read_name(r)};
    case ChangeTag::restrict:
      return read_restrict(r);
    case ChangeTag::lift: {
      Lift change{static_cast<RestrictionKind>(r.u8()), {}};
      change.subject = read_subject(r);
      return change;
    }
    case ChangeTag::protect:
      return Protect{read_protected_box(r)};
    case ChangeTag::unprotect:
      return Unprotect{read_name(r)};
    case ChangeTag::create_invite:
      return CreateInvite{read_invite(r)};
    case ChangeTag::accept_invite: {
      AcceptInvite change{r.u64(), {}};
      change.key = read_key(r);
      return change;
    }
    case ChangeTag::cancel_invite:
      return CancelInvite{r.u64()};
    case ChangeTag::set_password:
      return read_password(r);
    case ChangeTag::accept_password:
      return AcceptPassword{read_key(r)};
    case ChangeTag::define_role_with_quotas:
      return DefineRole{read_role_with_quotas(r)};
    case ChangeTag::correct_time: {
      CorrectTime change{r.svarint(), {}};
      change.since = r.varint();
      return change;
    }
  }
  r.reject(ErrorCode::unknown_kind, "unknown rights change");
  return RemoveRole{};
}

}  // namespace

Result<void> validate(const RightsChange& change) {
  return std::visit([](const auto& kind) { return check_change(kind); }, change);
}

void encode(const RightsChange& change, Bytes& out) {
  RUNSTONE_ASSERT(validate(change).has_value());
  ByteWriter w(out);
  w.u8(static_cast<std::uint8_t>(tag_of(change)));
  std::visit([&w](const auto& kind) { write_change(w, kind); }, change);
}

RightsChange read_rights_change(ByteReader& in) {
  RightsChange change;
  const auto tag = static_cast<ChangeTag>(in.u8());
  if (in.ok()) change = read_change_fields(in, tag);
  if (!in.finish()) return change;
  if (const auto valid = validate(change); !valid) {
    in.reject(valid.error().code, valid.error().what);
  }
  return change;
}

bool is_timed_grant(const RightsChange& change) {
  const auto* grant = std::get_if<GrantRole>(&change);
  return grant != nullptr && grant->until_us != 0;
}

std::optional<VoxelBox> place_of(const RightsChange& change) {
  const auto* protect = std::get_if<Protect>(&change);
  if (protect == nullptr) return std::nullopt;
  return protect->box.box;
}

}  // namespace runstone
