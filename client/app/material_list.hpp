// The mode --materials of runstone-client: lists the materials of a server's world.
#pragma once
#include <csignal>
#include <string>

#include "client/app/options.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns one line for each material in id order: "ID NAME", ids aligned to the right.
std::string material_list(const MaterialTable& materials);

/// Connects, prints material_list() to standard output and sends a goodbye. Returns kExitOk, or
/// kExitNoStart with a line on standard error if no world opened or `stop` was set by a signal.
int list_materials(const ClientOptions& options, const volatile std::sig_atomic_t& stop);

}  // namespace runstone
