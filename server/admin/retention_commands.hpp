// The commands about the retention of the log: retention, retention preview, retention run,
// retention stop.
#pragma once
#include <span>
#include <string>

#include "server/admin/command_row.hpp"
#include "server/history/retention_plan.hpp"

namespace runstone {

std::span<const CommandRow> retention_commands();

/// Returns a plan as lines for a person: the edits that would be removed and those that stay, the
/// bytes that come back, and how far the past would reach.
std::string retention_plan_text(const RetentionPlan& plan);

}  // namespace runstone
