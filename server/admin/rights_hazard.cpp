#include "server/admin/rights_hazard.hpp"

#include <algorithm>
#include <cstdint>
#include <variant>

#include "server/admin/address_range_text.hpp"
#include "server/admin/rights_change_text.hpp"

namespace runstone {
namespace {

constexpr unsigned kBitsBeforeIpv4 = 32;  // of an AddressBlock
constexpr unsigned kIpv4PrefixMin = 16, kIpv6PrefixMin = 32;
constexpr std::uint64_t kProtectedColumnsMax = 16'384 * 16'384;

bool is_v4(const AddressRange& range) {
  return range.bits >= kBitsBeforeIpv4 && static_cast<std::uint64_t>(range.first) >> 32 ==
                                              static_cast<std::uint64_t>(address_block_v4(0)) >> 32;
}

RightSet built_in_rights(const std::string& name) {
  for (const Role& role : built_in_roles()) {
    if (role.name == name) return role.rights;
  }
  return {};
}

/// Returns the rights of a role, as they are or as they would be after the change.
RightSet rights_of(const RightsState& state, const RightsChange* change, const std::string& name) {
  const auto* define = change == nullptr ? nullptr : std::get_if<DefineRole>(change);
  if (define != nullptr && define->role.name == name) return define->role.rights;
  const auto* remove = change == nullptr ? nullptr : std::get_if<RemoveRole>(change);
  if (remove != nullptr && remove->role == name) return built_in_rights(name);
  const Decided<Role>* role = state.find_role(name);
  return role == nullptr ? RightSet() : role->value.rights;
}

/// Returns the rights over others that a role has.
RightSet powers_of(const RightsState& state, const RightsChange* change, const std::string& name) {
  return rights_of(state, change, name).and_in(kRightsOverOthers);
}

std::optional<std::string> hazard_of_default_role(const RightsState& state,
                                                  const RightsChange& change) {
  const auto* set = std::get_if<SetDefaultRole>(&change);
  const std::string& before = state.default_role().value;
  const std::string& after = set == nullptr ? before : set->role;
  const RightSet gained =
      powers_of(state, &change, after).without(powers_of(state, nullptr, before));
  if (gained == RightSet()) return std::nullopt;
  return "everybody without a granted role, also who joins for the first time, would have the "
         "rights " +
         rights_text(gained) + " (grant PLAYER " + after + " gives them to one player)";
}

std::optional<std::string> hazard_of_role(const RightsState& state, const RightsChange& change,
                                          const std::string& name) {
  if (auto hazard = hazard_of_default_role(state, change)) return hazard;
  const auto& password = state.password().value;
  if (password && password->role == name) {
    const RightSet gained =
        powers_of(state, &change, name).without(powers_of(state, nullptr, name));
    if (gained != RightSet())
      return "whoever knows the password would have the rights " + rights_text(gained);
  }
  return std::nullopt;
}

std::optional<std::string> hazard_of_ban(const RightsState& state, const AddressRange& range) {
  const bool is_v4_range = is_v4(range);
  if (range.bits >= (is_v4_range ? kBitsBeforeIpv4 + kIpv4PrefixMin : kIpv6PrefixMin))
    return std::nullopt;
  std::string text = "nobody but administrators could join from " + text_of(range);
  if (is_v4_range) {
    text += ", " + std::to_string(std::uint64_t{1} << (64 - range.bits)) + " addresses";
  } else {
    text += range.bits == 0 ? ", all addresses there are" : ", the networks of many providers";
  }
  if (rights_of(state, nullptr, state.default_role().value).has(Right::administer))
    text += "; and it would keep out nobody without a granted role, because the default role " +
            state.default_role().value + " administers";
  return text;
}

std::uint64_t columns_of(const VoxelBox& box) {
  if (box.empty()) return 0;
  return static_cast<std::uint64_t>(box.max.x - box.min.x) *
         static_cast<std::uint64_t>(box.max.z - box.min.z);
}

/// A wide box that keeps its ground and rises to no higher priority needs no further warning.
std::optional<std::string> hazard_of_box(const RightsState& state, const ProtectedBox& box) {
  const std::uint64_t count = columns_of(box.box);
  if (count <= kProtectedColumnsMax) return std::nullopt;
  const Decided<ProtectedBox>* old = state.find_box(box.name);
  if (old != nullptr && old->value.box == box.box && box.priority <= old->value.priority)
    return std::nullopt;
  return box.name + " would protect " + ground_text(box.box) + ", " + std::to_string(count) +
         " columns of ground: nobody could build there but its owner, its members, its roles and "
         "whoever has the right " +
         std::string(name_of(Right::build_protected)) + ", apart from boxes of a higher priority";
}

}  // namespace

std::optional<std::string> hazard_of_lost_rights(const RightsState& state, const Role& role) {
  const Decided<Role>* old = state.find_role(role.name);
  const RightSet before = old == nullptr ? RightSet() : old->value.rights;
  const RightSet lost = before.without(role.rights);
  if (lost == RightSet()) return std::nullopt;
  const RightSet both = RightSet::of_bits(before.bits() | role.rights.bits());
  return "the role " + role.name + " would lose the rights " + rights_text(lost) +
         " (role set names all rights of a role: role set " + role.name + " " + rights_text(both) +
         " keeps them)";
}

std::optional<std::string> hazard_of(const RightsState& state, const RightsChange& change) {
  if (const auto* define = std::get_if<DefineRole>(&change))
    return hazard_of_role(state, change, define->role.name);
  if (const auto* remove = std::get_if<RemoveRole>(&change))
    return hazard_of_role(state, change, remove->role);
  if (std::holds_alternative<SetDefaultRole>(change)) return hazard_of_default_role(state, change);
  if (const auto* set = std::get_if<SetPassword>(&change); set != nullptr && set->password) {
    const RightSet powers = powers_of(state, nullptr, set->password->role);
    if (powers == RightSet()) return std::nullopt;
    return "whoever knows the password would have the rights " + rights_text(powers);
  }
  if (const auto* create = std::get_if<CreateInvite>(&change); create != nullptr) {
    const RightSet powers = powers_of(state, nullptr, create->invite.role);
    if (create->invite.uses == 1 || powers == RightSet()) return std::nullopt;
    return "the first " + std::to_string(create->invite.uses) +
           " players with the link would have the rights " + rights_text(powers);
  }
  if (const auto* protect = std::get_if<Protect>(&change))
    return hazard_of_box(state, protect->box);
  const auto* restricted = std::get_if<Restrict>(&change);
  const auto* range =
      restricted == nullptr ? nullptr : std::get_if<AddressRange>(&restricted->subject);
  return range == nullptr ? std::nullopt : hazard_of_ban(state, *range);
}

}  // namespace runstone
