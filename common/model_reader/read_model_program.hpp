// runstone-read-model: reads a model from a file and writes it to standard output as model bytes
// (common/models/model_bytes.hpp). It is a process of its own, because it parses what strangers made:
// a fault in a parser ends this process and no other. Before it opens the file, it gives up what it does
// not need (process_limits.hpp, model_folder.hpp). common/model_files starts it.
#pragma once

namespace runstone {

/// Runs the program. Returns the exit code: 0 if the model is written; 2 if it cannot be read, with one
/// line on standard error that begins with the name of the file; otherwise that of the library of the
/// command line. Changes the process for good.
int read_model_program(int argc, const char* const* argv);

}  // namespace runstone
