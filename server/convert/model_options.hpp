// The options of programs that say how a model becomes a build.
#pragma once
#include <CLI/CLI.hpp>

#include "common/models/model_choices.hpp"

namespace runstone {

/// Adds an option for each of kModelWords. Their values go to `choices`, which must outlive the
/// parsing.
void add_model_options(CLI::App& app, ModelChoices& choices);

}  // namespace runstone
