#include "bench/edits/store_bench.hpp"

#include <fmt/ostream.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/harness/statistics.hpp"
#include "common/postgres/postgres_database.hpp"
#include "server/store/store.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/edits/builder_session.hpp"

namespace runstone::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr unsigned kRounds = 10;

/// A schema of a database that is removed with the object.
class Schema {
 public:
  Schema(sql::Database database, std::string url)
      : database_(std::move(database)), url_(std::move(url)) {}
  ~Schema() {
    static_cast<void>(database_.run(("DROP SCHEMA " + name_ + " CASCADE").c_str()).has_value());
  }
  Schema(const Schema&) = delete;
  Schema& operator=(const Schema&) = delete;
  sql::Result<void> make() { return database_.run(("CREATE SCHEMA " + name_).c_str()); }
  sql::Result<std::string> version() { return database_.text("SHOW server_version"); }
  std::string place() const {
    return url_ + (url_.find('?') == std::string::npos ? "?" : "&") + "options=-csearch_path%3D" +
           name_;
  }

 private:
  sql::Database database_;
  const std::string url_;
  const std::string name_ = "runstone_bench_" + std::to_string(::getpid());
};

/// A world and the edits that it gets.
struct World {
  std::unique_ptr<Store> store;
  test::BuilderSession session{7};
  std::map<unsigned, std::vector<double>> ms = {};  // of the commits, by their number of edits

  Result<void, std::string> make(const std::string& place) {
    WorldMeta meta;
    meta.generator.name = "terrain";
    meta.materials = default_material_table();
    auto made = create_world(place, meta);
    if (!made) return failure(made.error().message());
    store = *std::move(made);
    const auto raised = store->raise_epoch();
    return raised ? Result<void, std::string>() : failure(raised.error().message());
  }
  Result<void, std::string> commit(unsigned batch) {
    std::vector<EditRecord> records;
    for (unsigned i = 0; i < batch; ++i) records.push_back(session.next());
    const auto start = Clock::now();
    if (const auto appended = store->append({}, records); !appended)
      return failure(appended.error().message());
    ms[batch].push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    return {};
  }
};

}  // namespace

Result<StoreBench, std::string> run_store_bench(const BenchOptions& options,
                                                std::ostream& progress) {
  auto database = sql::open_postgres(options.postgres, sql::PostgresMode::write);
  if (!database) return failure(database.error().file + ": " + database.error().what);
  Schema schema(*std::move(database), options.postgres);
  if (const auto made = schema.make(); !made) return failure(made.error().what);
  const test::TempFolder folder;
  StoreBench bench;
  if (const auto version = schema.version()) bench.postgres = *version;
  World sqlite, postgres;
  if (auto made = sqlite.make(folder / "world"); !made) return failure(made.error());
  if (auto made = postgres.make(schema.place()); !made) return failure(made.error());
  // Each kind is measured in several rounds, because a shared disk is slow for seconds.
  constexpr std::array kBatches = {1U, 16U, 128U, 1'024U};
  for (unsigned round = 0; round < kRounds; ++round) {
    for (const unsigned batch : kBatches) {
      for (unsigned i = 0; i < std::max(1U, options.repetitions / kRounds); ++i) {
        for (World* world : {&sqlite, &postgres}) {
          if (auto committed = world->commit(batch); !committed) return failure(committed.error());
        }
      }
    }
    fmt::print(progress, "round {} of {} is done\n", round + 1, kRounds);
  }
  bench.commits = static_cast<unsigned>(sqlite.ms[kBatches[0]].size());
  for (const unsigned batch : kBatches) {
    StoreCommits row;
    row.batch = batch;
    row.sqlite_ms = median(sqlite.ms[batch]);
    row.postgres_ms = median(postgres.ms[batch]);
    row.sqlite_edits = batch / row.sqlite_ms * 1000;
    row.postgres_edits = batch / row.postgres_ms * 1000;
    bench.batches.push_back(row);
  }
  return bench;
}

void write_table(const StoreBench& bench, std::ostream& out) {
  fmt::print(out, "{} commits of each kind, in turn; PostgreSQL {}\n\n", bench.commits,
             bench.postgres);
  fmt::print(out,
             "| edits a commit | SQLite ms | PostgreSQL ms | SQLite edits/s | PostgreSQL edits/s | "
             "ratio |\n|---|---|---|---|---|---|\n");
  for (const StoreCommits& row : bench.batches) {
    fmt::print(out, "| {} | {:.2f} | {:.2f} | {:.0f} | {:.0f} | {:.2f} |\n", row.batch,
               row.sqlite_ms, row.postgres_ms, row.sqlite_edits, row.postgres_edits,
               row.postgres_edits / row.sqlite_edits);
  }
}

void write_json(const StoreBench& bench, std::ostream& out) {
  nlohmann::ordered_json json = {{"commits", bench.commits}, {"postgres", bench.postgres}};
  for (const StoreCommits& row : bench.batches) {
    json["batches"].push_back({{"edits", row.batch},
                               {"sqlite_ms", row.sqlite_ms},
                               {"postgres_ms", row.postgres_ms},
                               {"sqlite_edits_a_second", row.sqlite_edits},
                               {"postgres_edits_a_second", row.postgres_edits}});
  }
  out << json.dump(2) << '\n';
}

}  // namespace runstone::bench
