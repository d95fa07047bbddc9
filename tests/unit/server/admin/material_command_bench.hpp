// MaterialCommandBench: the console of a server whose world has the materials of the sample.
#pragma once
#include <string>

#include "server/admin/command_table.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {

struct MaterialCommandBench : CommandBench {
  MaterialCommandBench() : CommandBench(with_sample_materials()) {}

  static WorldConfig with_sample_materials() {
    WorldConfig c = config();
    c.materials = sample_meta().materials;
    return c;
  }
  /// Gives a line, and lets the worker and the server answer.
  CommandAnswer give(const CommandCaller& caller, const std::string& line) {
    answers.clear();
    give_command({services, caller, bench.now(), reply()}, line);
    for (int i = 0; i < 2; ++i) {
      run_all();
      services.tick(bench.now());
    }
    return answer();
  }
  const MaterialTable& table() const { return bench.server.order().materials(); }

  CommandServices services{bench.server,
                           service,
                           *this,
                           placing,
                           folder.path(),
                           {},
                           [](const PublicKey&) { return false; }};
};

}  // namespace runstone::test
