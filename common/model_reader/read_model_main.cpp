#include <cstdlib>

#include "common/model_reader/read_model_program.hpp"

int main(int argc, char** argv) {
  // The memory of a large scene need not be freed piece by piece.
  std::_Exit(runstone::read_model_program(argc, argv));
}
