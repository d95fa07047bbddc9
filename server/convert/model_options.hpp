// The options of programs that say how a model becomes a build.
#pragma once
#include <CLI/CLI.hpp>

#include "common/build_files/model_reading.hpp"

namespace runstone {

/// Adds --voxels, --voxels-per-metre, --surface, --hollow, --fill-overlaps and --up. Their values go to
/// `reading`, which must outlive the parsing.
void add_model_options(CLI::App& app, ModelReading& reading);

}  // namespace runstone
