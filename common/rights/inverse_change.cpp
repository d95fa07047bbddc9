#include <algorithm>
#include <variant>

#include "common/rights/change_rules.hpp"

namespace runstone {
namespace {

/// Names the part of the state that a change sets.
struct ChangedCell {
  enum class Kind : std::uint8_t {
    role,
    grant,
    default_role,
    restriction,
    box,
    invite,
    password,
    time
  };
  Kind kind{};
  std::string name;  // of the role or box; the number of the invite
  RestrictionKind restriction{};
  RestrictionSubject subject;  // of the restriction; of the grant, a key
  friend bool operator==(const ChangedCell&, const ChangedCell&) = default;
};

using CellKind = ChangedCell::Kind;

ChangedCell cell_of_kind(const DefineRole& c) { return {CellKind::role, c.role.name, {}, {}}; }
ChangedCell cell_of_kind(const RemoveRole& c) { return {CellKind::role, c.role, {}, {}}; }
ChangedCell cell_of_kind(const GrantRole& c) { return {CellKind::grant, {}, {}, c.key}; }
ChangedCell cell_of_kind(const SetDefaultRole&) { return {CellKind::default_role, {}, {}, {}}; }
ChangedCell cell_of_kind(const Restrict& c) {
  return {CellKind::restriction, {}, c.kind, c.subject};
}
ChangedCell cell_of_kind(const Lift& c) { return {CellKind::restriction, {}, c.kind, c.subject}; }
ChangedCell cell_of_kind(const Protect& c) { return {CellKind::box, c.box.name, {}, {}}; }
ChangedCell cell_of_kind(const Unprotect& c) { return {CellKind::box, c.box, {}, {}}; }
ChangedCell cell_of_kind(const CreateInvite& c) {
  return {CellKind::invite, std::to_string(c.invite.id), {}, {}};
}
ChangedCell cell_of_kind(const AcceptInvite& c) { return {CellKind::grant, {}, {}, c.key}; }
ChangedCell cell_of_kind(const CancelInvite& c) {
  return {CellKind::invite, std::to_string(c.invite), {}, {}};
}
ChangedCell cell_of_kind(const SetPassword&) { return {CellKind::password, {}, {}, {}}; }
ChangedCell cell_of_kind(const AcceptPassword& c) { return {CellKind::grant, {}, {}, c.key}; }
ChangedCell cell_of_kind(const CorrectTime&) { return {CellKind::time, {}, {}, {}}; }

/// Returns true if the role that a player gets on joining may depend on the record: if it is about
/// invites, passwords or grants.
bool is_about_joining(const RightsChange& change) {
  return std::holds_alternative<GrantRole>(change) ||
         std::holds_alternative<CreateInvite>(change) ||
         std::holds_alternative<AcceptInvite>(change) ||
         std::holds_alternative<CancelInvite>(change) ||
         std::holds_alternative<SetPassword>(change) ||
         std::holds_alternative<AcceptPassword>(change);
}

ChangedCell cell_of(const RightsChange& change) {
  return std::visit([](const auto& kind) { return cell_of_kind(kind); }, change);
}

/// Returns the change that gives the cell the value that it has in `state`. Requires that the cell is
/// not the time.
RightsChange restoring(const RightsState& state, const ChangedCell& cell) {
  switch (cell.kind) {
    case CellKind::role: {
      const Decided<Role>* role = state.find_role(cell.name);
      if (role == nullptr) return RemoveRole{cell.name};
      const auto built_in = built_in_roles();
      const bool is_built_in =
          std::find(built_in.begin(), built_in.end(), role->value) != built_in.end();
      if (is_built_in) return RemoveRole{cell.name};
      return DefineRole{role->value};
    }
    case CellKind::grant: {
      const auto& key = std::get<PublicKey>(cell.subject);
      const auto grant = state.grants().find(key);
      return GrantRole{key, grant == state.grants().end() ? "" : grant->second.value};
    }
    case CellKind::default_role:
      return SetDefaultRole{state.default_role().value};
    case CellKind::password:
      return SetPassword{state.password().value};
    case CellKind::restriction: {
      const auto* old = state.find_restriction(cell.restriction, cell.subject);
      if (old == nullptr) return Lift{cell.restriction, cell.subject};
      return old->value;
    }
    case CellKind::invite: {
      const InviteId id = std::stoull(cell.name);
      const auto found = state.invites().find(id);
      if (found == state.invites().end() ||
          found->second.value.accepted >= found->second.value.invite.uses)
        return CancelInvite{id};
      // The invite begins anew with the uses that it had left.
      Invite invite = found->second.value.invite;
      invite.uses -= found->second.value.accepted;
      return CreateInvite{invite};
    }
    case CellKind::box:
    case CellKind::time:
      break;
  }
  const Decided<ProtectedBox>* box = state.find_box(cell.name);
  if (box == nullptr) return Unprotect{cell.name};
  return Protect{box->value};
}

}  // namespace

std::optional<RightsChange> inverse_of(const std::vector<RightsRecord>& records, Sequence seq) {
  const auto at = std::find_if(records.begin(), records.end(), [seq](const RightsRecord& record) {
    return record.origin.seq == seq;
  });
  if (at == records.end()) return std::nullopt;
  const ChangedCell cell = cell_of(at->change);
  if (cell.kind == CellKind::time) return std::nullopt;
  const bool is_replaced = std::any_of(at + 1, records.end(), [&](const RightsRecord& later) {
    return cell_of(later.change) == cell;
  });
  if (is_replaced) return std::nullopt;
  RightsState before;
  for (auto record = records.begin(); record != records.end(); ++record) {
    const bool is_before =
        record < at && (cell_of(record->change) == cell || is_about_joining(record->change));
    // A later correction of the time moves the ends that were given before.
    if (is_before || std::holds_alternative<CorrectTime>(record->change))
      before.apply(record->change, record->origin);
  }
  return restoring(before, cell);
}

}  // namespace runstone
