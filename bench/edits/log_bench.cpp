#include "bench/edits/log_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "bench/harness/statistics.hpp"
#include "common/core/hash.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/history/keyframe_maker.hpp"
#include "server/rollback/restore_plan.hpp"
#include "server/rollback/selection.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/edits/builder_session.hpp"

namespace runstone::bench {
namespace {

constexpr TimeUs kMinute = 60'000'000;
constexpr std::int32_t kViewRadius = 8;    // chunks
constexpr AuthorId kFirstGriefer = 1'000;  // the builders have smaller numbers

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Returns the bytes of the database, with everything that its WAL holds.
double bytes_of(const std::string& folder) {
  std::error_code ignored;
  return static_cast<double>(std::filesystem::file_size(folder + "/world.sqlite", ignored));
}

/// Closes the store, so that the file contains the WAL, and opens it again.
Result<void, std::string> reopen(std::unique_ptr<Store>& store, const std::string& folder) {
  store.reset();
  auto opened = open_sqlite_world(folder, StoreAccess::read_write, {"", false});
  if (!opened) return failure(opened.error().message());
  store = *std::move(opened);
  return {};
}

struct Sampled {
  std::vector<EditRecord> records;  // spread evenly over the log
};

Result<Sampled, std::string> fill(Store& store, std::uint64_t edits, unsigned samples,
                                  double& append_us) {
  if (auto raised = store.raise_epoch(); !raised) return failure(raised.error().message());
  test::BuilderSession session(7);
  Sampled sampled;
  std::vector<EditRecord> batch;
  const auto start = Clock::now();
  for (std::uint64_t i = 0; i < edits; ++i) {
    batch.push_back(session.next());
    if (i % std::max<std::uint64_t>(1, edits / samples) == 0)
      sampled.records.push_back(batch.back());
    if (batch.size() < 64 && i + 1 < edits) continue;
    if (auto appended = store.append({}, batch); !appended)
      return failure(appended.error().message());
    batch.clear();
  }
  append_us = ms_since(start) * 1000 / static_cast<double>(edits);
  return sampled;
}

VoxelBox around(const EditRecord& record, std::int32_t reach) {
  const VoxelPos at = bounding_box(record.edit).min;
  return {{at.x - reach, at.y - reach, at.z - reach}, {at.x + reach, at.y + reach, at.z + reach}};
}

Result<std::vector<LogQuestion>, std::string> ask(Store& store,
                                                  const std::vector<EditRecord>& sampled) {
  const std::vector<std::pair<std::string, std::function<LogQuery(const EditRecord&)>>> sorts = {
      {"one minute of the log",
       [](const EditRecord& r) {
         LogQuery query;
         query.from_us = r.time_us;
         query.until_us = r.time_us + kMinute;
         return query;
       }},
      {"ten minutes of one author",
       [](const EditRecord& r) {
         LogQuery query;
         query.author = r.op.author;
         query.from_us = r.time_us;
         query.until_us = r.time_us + 10 * kMinute;
         return query;
       }},
      {"who set this voxel, ever",
       [](const EditRecord& r) {
         LogQuery query;
         query.box = bounding_box(r.edit);
         return query;
       }},
      {"box of 16, ever",
       [](const EditRecord& r) {
         LogQuery query;
         query.box = around(r, 8);
         return query;
       }},
      {"box of 16, one author, one hour",
       [](const EditRecord& r) {
         LogQuery query;
         query.box = around(r, 8);
         query.author = r.op.author;
         query.from_us = r.time_us - 30 * kMinute;
         query.until_us = r.time_us + 30 * kMinute;
         return query;
       }},
      {"all rollbacks", [](const EditRecord&) {
         LogQuery query;
         query.cause = Cause::rollback;
         return query;
       }}};
  std::vector<LogQuestion> questions;
  for (const auto& [name, query_at] : sorts) {
    std::vector<double> times;
    std::vector<EditRecord> found;
    std::size_t all = 0;
    for (const EditRecord& record : sampled) {
      found.clear();
      const auto start = Clock::now();
      const auto queried = store.query_log(query_at(record), [&](const EditRecord& answer) {
        found.push_back(answer);
        return true;
      });
      if (!queried) return failure(queried.error().message());
      times.push_back(ms_since(start));
      all += found.size();
    }
    questions.push_back({name, static_cast<double>(all) / static_cast<double>(times.size()),
                         median(times), quantile(times, 1)});
  }
  return questions;
}

Result<LogMoments, std::string> visit(const std::string& folder, const Generator& generator,
                                      unsigned moments, std::uint64_t edits) {
  LogMoments result;
  SplitMix64 rng(11);
  std::vector<double> open_ms, view_ms, all_ms;
  for (unsigned i = 0; i < moments; ++i) {
    const Sequence at = 1 + rng.next() % edits;
    auto reader = open_sqlite_world(folder, StoreAccess::read_only, {"", false});
    if (!reader) return failure(reader.error().message());
    result.keyframes = (*reader)->keyframes()->size();
    ChunkCoord centre;
    const auto last = (*reader)->read_log(at, at, [&](const EditRecord& record) {
      centre = chunk_of(bounding_box(record.edit).min, (*reader)->meta().chunk_edge);
      return true;
    });
    if (!last) return failure(last.error().message());
    const auto start = Clock::now();
    auto world = WorldAt::open(**reader, generator, at);
    if (!world) return failure(world.error().message());
    open_ms.push_back(ms_since(start));
    const auto make = [&](const ChunkKey& key) -> Result<void, std::string> {
      const auto chunk = world->chunk(key);
      if (!chunk) return failure(chunk.error().message());
      return {};
    };
    const auto viewing = Clock::now();
    for (std::int32_t x = -kViewRadius; x <= kViewRadius; ++x) {
      for (std::int32_t y = -kViewRadius; y <= kViewRadius; ++y) {
        for (std::int32_t z = -kViewRadius; z <= kViewRadius; ++z) {
          if (x * x + y * y + z * z > kViewRadius * kViewRadius) continue;
          if (auto made = make({0, {centre.x + x, centre.y + y, centre.z + z}}); !made)
            return failure(made.error());
        }
      }
    }
    view_ms.push_back(open_ms.back() + ms_since(viewing));
    const auto making = Clock::now();
    const auto edited = world->edited();
    for (const ChunkKey& key : edited) {
      if (auto made = make(key); !made) return failure(made.error());
    }
    all_ms.push_back(open_ms.back() + ms_since(making));
    result.edits_read += static_cast<double>(at - world->stored_at());
    result.chunks += static_cast<double>(edited.size());
  }
  result.moments = open_ms.size();
  result.edits_read /= static_cast<double>(result.moments);
  result.chunks /= static_cast<double>(result.moments);
  result.open_ms = median(open_ms);
  result.open_slowest_ms = quantile(open_ms, 1);
  result.view_ms = median(view_ms);
  result.view_slowest_ms = quantile(view_ms, 1);
  result.all_ms = median(all_ms);
  result.all_slowest_ms = quantile(all_ms, 1);
  return result;
}

/// Appends edits of one author, one each 10 ms, scattered over a square: boxes with sides up to
/// `side_max`, or single voxels if that is 1.
Result<void, std::string> scatter(Store& store, AuthorId author, std::uint64_t count,
                                  std::int32_t side_max) {
  constexpr std::int32_t kSide = 1'600, kHeight = 32;
  const auto range = store.log_range();
  if (!range) return failure(range.error().message());
  SplitMix64 rng(author);
  EditRecord record;
  record.version = range->last.version;
  record.time_us = range->last.time_us;
  record.op = {author, 1, 0};
  std::vector<EditRecord> batch;
  for (std::uint64_t i = 1; i <= count; ++i) {
    ++record.version.seq;
    ++record.op.seq;
    record.time_us += 10'000;
    const VoxelPos at{rng.between(0, kSide - 1), rng.between(0, kHeight - 1),
                      rng.between(0, kSide - 1)};
    record.edit = {SetVoxel{at}, {}, Material{1}};
    if (side_max > 1) {
      const VoxelPos end{at.x + rng.between(1, side_max), at.y + rng.between(1, side_max),
                         at.z + rng.between(1, side_max)};
      record.edit.shape = FillBox{{at, end}};
    }
    batch.push_back(record);
    if (batch.size() < 64 && i < count) continue;
    if (auto appended = store.append({}, batch); !appended)
      return failure(appended.error().message());
    batch.clear();
  }
  return {};
}

/// Adds up what `make` makes of the chunks. `make` gets a planner, the selected chunks and the
/// function that takes the voxels of a chunk, or an error.
template <class Make>
Result<std::uint64_t, std::string> voxels_of(Store& store, const Generator& generator,
                                             const Selection& selection, const Make& make) {
  std::vector<RestorePlanner::Item> items;
  items.reserve(selection.chunks.size());
  for (const auto& [key, edits] : selection.chunks) items.push_back({key, edits});
  RestorePlanner planner(store, generator);
  std::uint64_t sum = 0;
  std::string error;
  make(planner, items, [&](const StoreResult<std::uint64_t>& voxels) {
    if (!voxels) error = voxels.error().message();
    if (voxels) sum += *voxels;
    return voxels.has_value();
  });
  if (!error.empty()) return failure(error);
  return sum;
}

Result<LogPreview, std::string> preview(const std::string& name, Store& store,
                                        const Generator& generator, AuthorId author,
                                        unsigned repetitions) {
  const auto range = store.log_range();
  if (!range) return failure(range.error().message());
  const Sequence end = range->last.version.seq;
  SelectionFilter filter;
  filter.authors = {author};
  filter.from_us = range->last.time_us - 60 * kMinute;
  LogPreview result;
  result.name = name;
  std::vector<double> select_ms, count_ms, preview_ms, plan_ms;
  for (unsigned i = 0; i < repetitions; ++i) {
    const auto selecting = Clock::now();
    const auto selection = select_edits(store, filter);
    if (!selection) return failure(selection.error().message());
    select_ms.push_back(ms_since(selecting));
    result.edits = selection->edits;
    result.chunks = selection->chunks.size();
    const auto counting = Clock::now();
    const auto counted = voxels_of(
        store, generator, *selection, [&](RestorePlanner& planner, const auto& items, auto take) {
          planner.count_all(items, std::nullopt, end,
                            [&](const ChunkKey&, const StoreResult<std::uint64_t>& voxels) {
                              return take(voxels);
                            });
        });
    if (!counted) return failure(counted.error());
    count_ms.push_back(ms_since(counting));
    preview_ms.push_back(ms_since(selecting));
    const auto planning = Clock::now();
    const auto planned = voxels_of(
        store, generator, *selection, [&](RestorePlanner& planner, const auto& items, auto take) {
          planner.plan_all(items, std::nullopt, end,
                           [&](const ChunkKey&, const StoreResult<RestorePlan>& plan) {
                             if (!plan) return take(failure(plan.error()));
                             return take(plan->voxels);
                           });
        });
    if (!planned) return failure(planned.error());
    plan_ms.push_back(ms_since(planning));
    if (*counted != *planned) return failure(name + ": the preview and the plans differ");
    result.voxels = *counted;
  }
  const auto summarise = [](std::vector<double>& times, double& middle, double& slowest) {
    middle = median(times);
    slowest = quantile(times, 1);
  };
  summarise(select_ms, result.select_ms, result.select_slowest_ms);
  summarise(count_ms, result.count_ms, result.count_slowest_ms);
  summarise(preview_ms, result.preview_ms, result.preview_slowest_ms);
  summarise(plan_ms, result.plan_ms, result.plan_slowest_ms);
  return result;
}

}  // namespace

Result<LogBench, std::string> run_log_bench(const BenchOptions& options, std::ostream& progress) {
  const test::TempFolder folder;
  LogBench bench;
  bench.edits = options.edits;
  WorldMeta meta;
  meta.generator.name = "terrain";
  meta.materials = default_material_table();
  const auto generator = make_generator(meta.generator, meta.materials);
  if (!generator) return failure(generator.error().what);
  auto created = create_sqlite_world(folder.path(), meta, {"", false});
  if (!created) return failure(created.error().message());
  auto store = *std::move(created);
  const auto sampled = fill(*store, options.edits, options.repetitions, bench.append_us);
  if (!sampled) return failure(sampled.error());
  if (auto opened = reopen(store, folder.path()); !opened) return failure(opened.error());
  const double plain = bytes_of(folder.path());
  bench.bytes = plain / static_cast<double>(options.edits);
  fmt::print(progress, "the log is there\n");

  auto questions = ask(*store, sampled->records);
  if (!questions) return failure(questions.error());
  bench.questions = *std::move(questions);
  const auto visit_moments = [&]() -> Result<void, std::string> {
    auto moments = visit(folder.path(), **generator, options.repetitions, options.edits);
    if (!moments) return failure(moments.error());
    bench.moments.push_back(*std::move(moments));
    return {};
  };
  if (auto visited = visit_moments(); !visited) return failure(visited.error());
  fmt::print(progress, "moments without keyframes are done\n");

  KeyframeMaker maker(*store, **generator, {});
  const auto start = Clock::now();
  const auto made = maker.make_due(
      [&](const KeyframeMaker::Chunks& chunks, const std::optional<Keyframe>& keyframe) {
        bench.keyframe_chunks += chunks.size();
        return store->save_keyframe(chunks, keyframe);
      });
  if (!made) return failure(made.error().message());
  bench.keyframes_seconds = ms_since(start) / 1000;
  if (auto opened = reopen(store, folder.path()); !opened) return failure(opened.error());
  bench.keyframe_bytes = (bytes_of(folder.path()) - plain) / static_cast<double>(options.edits);
  if (auto visited = visit_moments(); !visited) return failure(visited.error());
  fmt::print(progress, "moments with keyframes are done\n");
  const auto add_preview = [&](const std::string& name,
                               AuthorId author) -> Result<void, std::string> {
    auto previewed = preview(name, *store, **generator, author, options.repetitions);
    if (!previewed) return failure(previewed.error());
    bench.previews.push_back(*std::move(previewed));
    return {};
  };
  if (auto done = add_preview("a builder", sampled->records.back().op.author); !done)
    return failure(done.error());
  AuthorId griefer = kFirstGriefer;
  struct Griefing {
    std::uint64_t edits;
    std::int32_t side_max;
  };
  for (const Griefing& most : {Griefing{12'000, 1}, Griefing{60'000, 1}, Griefing{8'000, 8}}) {
    const std::uint64_t edits = std::min(most.edits, options.edits);
    if (auto scattered = scatter(*store, ++griefer, edits, most.side_max); !scattered)
      return failure(scattered.error());
    const std::string name =
        std::to_string(edits) + (most.side_max == 1 ? " scattered voxels" : " scattered boxes");
    if (auto done = add_preview(name, griefer); !done) return failure(done.error());
    fmt::print(progress, "the preview of {} is done\n", name);
  }
  return bench;
}

void write_table(const LogBench& bench, std::ostream& out) {
  fmt::print(out,
             "{} edits, {:.1f} bytes each, appended in {:.2f} us each; "
             "keyframes add {:.1f} bytes an edit ({} chunks, made in {:.1f} s)\n\n",
             bench.edits, bench.bytes, bench.append_us, bench.keyframe_bytes, bench.keyframe_chunks,
             bench.keyframes_seconds);
  fmt::print(out, "| question | edits found, mean | median ms | slowest ms |\n|---|---|---|---|\n");
  for (const LogQuestion& q : bench.questions) {
    fmt::print(out, "| {} | {:.1f} | {:.2f} | {:.1f} |\n", q.name, q.found, q.median_ms,
               q.slowest_ms);
  }
  fmt::print(out,
             "\n| keyframes | moments | edits read, mean | chunks edited, mean | "
             "opened, median ms | slowest | view | slowest | all edited chunks | slowest |\n"
             "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const LogMoments& m : bench.moments) {
    fmt::print(
        out,
        "| {} | {} | {:.0f} | {:.0f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n",
        m.keyframes, m.moments, m.edits_read, m.chunks, m.open_ms, m.open_slowest_ms, m.view_ms,
        m.view_slowest_ms, m.all_ms, m.all_slowest_ms);
  }
  fmt::print(
      out,
      "\n| preview of one author's last hour | edits | chunks | voxels | selected, median ms | "
      "counted | preview | slowest | all chunks planned | slowest |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const LogPreview& p : bench.previews) {
    fmt::print(out, "| {} | {} | {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n",
               p.name, p.edits, p.chunks, p.voxels, p.select_ms, p.count_ms, p.preview_ms,
               p.preview_slowest_ms, p.plan_ms, p.plan_slowest_ms);
  }
}

void write_json(const LogBench& bench, std::ostream& out) {
  nlohmann::ordered_json json = {{"edits", bench.edits},
                                 {"bytes_an_edit", bench.bytes},
                                 {"append_us_an_edit", bench.append_us},
                                 {"keyframe_bytes_an_edit", bench.keyframe_bytes},
                                 {"keyframe_chunks", bench.keyframe_chunks},
                                 {"keyframes_seconds", bench.keyframes_seconds}};
  for (const LogQuestion& q : bench.questions) {
    json["questions"].push_back({{"name", q.name},
                                 {"found", q.found},
                                 {"median_ms", q.median_ms},
                                 {"slowest_ms", q.slowest_ms}});
  }
  for (const LogMoments& m : bench.moments) {
    json["moments"].push_back({{"keyframes", m.keyframes},
                               {"moments", m.moments},
                               {"edits_read", m.edits_read},
                               {"chunks", m.chunks},
                               {"open_ms", m.open_ms},
                               {"open_slowest_ms", m.open_slowest_ms},
                               {"view_ms", m.view_ms},
                               {"view_slowest_ms", m.view_slowest_ms},
                               {"all_ms", m.all_ms},
                               {"all_slowest_ms", m.all_slowest_ms}});
  }
  for (const LogPreview& p : bench.previews) {
    json["previews"].push_back({{"name", p.name},
                                {"edits", p.edits},
                                {"chunks", p.chunks},
                                {"voxels", p.voxels},
                                {"select_ms", p.select_ms},
                                {"select_slowest_ms", p.select_slowest_ms},
                                {"count_ms", p.count_ms},
                                {"count_slowest_ms", p.count_slowest_ms},
                                {"preview_ms", p.preview_ms},
                                {"preview_slowest_ms", p.preview_slowest_ms},
                                {"plan_ms", p.plan_ms},
                                {"plan_slowest_ms", p.plan_slowest_ms}});
  }
  out << json.dump(1) << '\n';
}

}  // namespace runstone::bench
