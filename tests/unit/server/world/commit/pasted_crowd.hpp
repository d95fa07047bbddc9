// PastedCrowd: 20 players in one place, of whom the first has sent more large pastes than may be
// ordered at once.
#pragma once
#include "tests/support/edits/hostile_edits.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {

struct PastedCrowd : WorldBench {
  explicit PastedCrowd(ClientSequence pastes) : WorldBench(without_budget()) {
    for (SessionId s = 1; s <= 20; ++s) {
      join(s, static_cast<std::uint8_t>(s));
      view(s, kSmall);
    }
    for (ClientSequence seq = 1; seq <= pastes; ++seq) edit(1, seq, paste, kEmpty);
    server.commit(now());
  }
  static WorldConfig without_budget() {
    WorldConfig c = config();
    c.edit_budget = {};  // no limit
    return c;
  }
  const EditShape paste = Paste{{0, 0, 0}, long_clipboard(), {}};
};

}  // namespace runstone::test
