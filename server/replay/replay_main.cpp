#include <iostream>

#include "common/os/program.hpp"
#include "server/replay/replay_program.hpp"
#include "server/replay/subcommand.hpp"

int main(int argc, char** argv) {
  return runstone::run_program("runstone-replay", runstone::kReplayCannotRead, [&] {
    return runstone::replay_program(argc, argv, std::cout, std::cerr);
  });
}
