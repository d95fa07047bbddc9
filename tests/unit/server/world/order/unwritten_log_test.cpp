#include "server/world/order/unwritten_log.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/unit/server/world/cluster/cluster_bench.hpp"

namespace runstone::test {
namespace {

LogPart records_of(Sequence first, Sequence last) {
  LogPart part;
  for (Sequence seq = first; seq <= last; ++seq) {
    LogPartRecord one;
    one.record.version = {1, seq};
    part.records.push_back(one);
  }
  return part;
}

LogPart name_of(const std::string& name) {
  LogPart part;
  part.names.push_back({name, name, {}, false});
  return part;
}

/// Returns the last sequence of each part, 0 for one without records.
std::vector<Sequence> ends_of(const UnwrittenLog& log) {
  std::vector<Sequence> ends;
  for (const LogPart& part : log.parts())
    ends.push_back(part.records.empty() ? 0 : part.records.back().record.version.seq);
  return ends;
}

}  // namespace

TEST_CASE("what is durable is forgotten, with the rows before it", "[world][servers]") {
  UnwrittenLog log;
  log.add(records_of(1, 2));
  log.add(name_of("a"));
  log.add(records_of(3, 5));
  log.add(name_of("b"));
  log.durable(1);
  CHECK(ends_of(log) == std::vector<Sequence>{2, 0, 5, 0});
  log.durable(2);
  CHECK(ends_of(log) == std::vector<Sequence>{0, 5, 0});
  log.durable(4);  // the part is not durable as a whole
  CHECK(ends_of(log) == std::vector<Sequence>{0, 5, 0});
  log.durable(5);
  CHECK(ends_of(log) == std::vector<Sequence>{0});
  log.durable(9);
  CHECK(ends_of(log) == std::vector<Sequence>{0});
  log.add(records_of(6, 6));
  CHECK(log.bytes() >= 2 * sizeof(LogPart) + sizeof(LogPartRecord));
  log.durable(6);
  CHECK(ends_of(log).empty());
  CHECK(log.bytes() == 0);
}

TEST_CASE("of rows without records, only the newest are kept", "[world][servers]") {
  UnwrittenLog log;
  log.add(name_of("first"));
  log.add(records_of(1, 1));
  for (std::size_t i = 0; i < kUnwrittenRowsMax; ++i) log.add(name_of("later"));
  CHECK(log.parts().size() == kUnwrittenRowsMax + 1);
  CHECK(log.parts().front().records.size() == 1);
  log.clear();
  log.add(name_of("again"));
  CHECK(log.parts().size() == 1);
}

TEST_CASE("a server that comes gets what is not durable from the owner, and waits for no disk",
          "[world][servers]") {
  ClusterBench bench(0);
  bench.join(0, 1, 1);
  bench.edit(0, 1, 1, SetVoxel{{1, 1, 1}});
  bench.run();
  bench.durable_max = 1;
  for (ClientSequence seq = 2; seq <= 4; ++seq) {
    bench.edit(0, 1, seq, SetVoxel{{static_cast<std::int32_t>(seq), 1, 1}});
    bench.run();
  }
  const std::size_t late = bench.add_follower();
  bench.connect(late);
  bench.pump();
  CHECK(bench.world(late).cluster().is_live());
  CHECK(bench.world(late).order().head() == 4);
  CHECK(bench.world(late).order().durable() == 1);
  CHECK(bench.sent<FollowAnswer>(0, bench.servers[late].link).at(0).head == 1);
  bench.edit(0, 1, 5, SetVoxel{{5, 1, 1}});
  bench.durable_max = 5;
  bench.run();
  CHECK(bench.world(late).order().head() == 5);
  CHECK(bench.world(late).order().durable() == 5);
}

TEST_CASE("a server with records that are not durable compares them with the database",
          "[world][servers]") {
  ClusterBench bench(2);
  bench.join(0, 1, 1);
  bench.durable_max = 0;
  bench.edit(0, 1, 1, SetVoxel{{1, 1, 1}});
  bench.run();
  CHECK(bench.world(2).order().head() == 1);
  bench.cut(2);
  bench.connect(2);
  bench.pump();
  CHECK_FALSE(bench.world(2).cluster().is_live());
  bench.durable_max = 1;
  for (int i = 0; i < 3; ++i) bench.tick();
  CHECK(bench.world(2).cluster().is_live());
  CHECK(bench.world(2).order().head() == 1);
}

}  // namespace runstone::test
