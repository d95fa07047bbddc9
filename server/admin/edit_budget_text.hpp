// Edit budgets as texts, in settings and in roles: a name such as "normal", or units a second and
// units at once, such as "300/9000".
#pragma once
#include <array>
#include <optional>
#include <string>

#include "common/core/budget.hpp"

namespace runstone {

/// The budgets that have a name. docs/server-reference.md has the prices of edits.
struct NamedBudget {
  const char* name;
  Budget budget;
};
inline constexpr std::array<NamedBudget, 4> kNamedBudgets = {{{"small", {25, 1'000}},
                                                              {"normal", {100, 4'000}},
                                                              {"large", {1'000, 40'000}},
                                                              {"unlimited", {}}}};

/// Returns the names and the form of other budgets, for messages about a wrong text.
std::string edit_budget_rule();
/// Returns nullopt if the text is neither a name nor a budget within kBudgetPerSecondMax and
/// kBudgetBurstMax.
std::optional<Budget> parse_edit_budget(const std::string& text);
/// Returns the name of a budget that has one.
std::string text_of(const Budget& edit_budget);

}  // namespace runstone
