#include "server/admin/edit_budget_text.hpp"

#include <charconv>
#include <system_error>

namespace runstone {

std::string edit_budget_rule() {
  std::string names;
  for (const NamedBudget& named : kNamedBudgets) names += std::string(named.name) + ", ";
  return names + "or like 100/4000: 1.." + std::to_string(kBudgetPerSecondMax) +
         " units a second / 1.." + std::to_string(kBudgetBurstMax) + " at once";
}

std::optional<Budget> parse_edit_budget(const std::string& text) {
  for (const NamedBudget& named : kNamedBudgets) {
    if (text == named.name) return named.budget;
  }
  Budget budget;
  const char* end = text.data() + text.size();
  const auto rate = std::from_chars(text.data(), end, budget.per_second);
  if (rate.ec != std::errc{} || rate.ptr == end || *rate.ptr != '/') return std::nullopt;
  const auto burst = std::from_chars(rate.ptr + 1, end, budget.burst);
  const bool is_valid = burst.ec == std::errc{} && burst.ptr == end && budget.per_second >= 1 &&
                        budget.per_second <= kBudgetPerSecondMax && budget.burst >= 1 &&
                        budget.burst <= kBudgetBurstMax;
  if (!is_valid) return std::nullopt;
  return budget;
}

std::string text_of(const Budget& edit_budget) {
  for (const NamedBudget& named : kNamedBudgets) {
    if (named.budget == edit_budget) return named.name;
  }
  return std::to_string(edit_budget.per_second) + "/" + std::to_string(edit_budget.burst);
}

}  // namespace runstone
