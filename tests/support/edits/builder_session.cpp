#include "tests/support/edits/builder_session.hpp"

#include <algorithm>

namespace runstone::test {
namespace {

constexpr std::int64_t kStartUs = 1'700'000'000'000'000;

std::int32_t& along(VoxelPos& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

}  // namespace

BuilderSession::BuilderSession(std::uint64_t seed, AuthorId authors) : rng_(seed) {
  for (AuthorId i = 0; i < authors; ++i) {
    Builder builder;
    builder.home = {rng_.between(-2000, 2000), rng_.between(10, 60), rng_.between(-2000, 2000)};
    if (i % 3 == 2) builder.home = builders_.back().home;  // two on one site
    builder.instance = rng_.next();
    builder.due_us = kStartUs + rng_.below(1'000'000);
    begin_stroke(builder);
    builders_.push_back(builder);
  }
}

void BuilderSession::begin_stroke(Builder& builder) {
  if (rng_.below(200) == 0) {  // walks on
    builder.home.x += rng_.between(-300, 300);
    builder.home.z += rng_.between(-300, 300);
  }
  builder.at = {builder.home.x + rng_.between(-24, 24), builder.home.y + rng_.between(0, 24),
                builder.home.z + rng_.between(-24, 24)};
  builder.axis = static_cast<int>(rng_.below(3));
  builder.row_axis = (builder.axis + 1 + static_cast<int>(rng_.below(2))) % 3;
  builder.step = rng_.below(2) == 0 ? 1 : -1;
  builder.row_length = rng_.between(1, 16);
  builder.left = builder.row_length;
  builder.rows = rng_.below(3) == 0 ? rng_.between(2, 8) : 1;
  builder.material = rng_.below(4) == 0 ? kEmpty : static_cast<Material>(1 + rng_.below(24));
  builder.due_us += rng_.between(500'000, 4'000'000);
}

void BuilderSession::advance(Builder& builder) {
  if (--builder.left > 0) {
    along(builder.at, builder.axis) += builder.step;
  } else if (--builder.rows > 0) {
    along(builder.at, builder.row_axis) += 1;
    builder.step = -builder.step;
    builder.left = builder.row_length;
  } else {
    begin_stroke(builder);
  }
}

EditRecord BuilderSession::next() {
  Builder& builder =
      *std::min_element(builders_.begin(), builders_.end(),
                        [](const auto& a, const auto& b) { return a.due_us < b.due_us; });
  EditRecord record;
  record.version = {1, ++seq_};
  const auto author = static_cast<AuthorId>(1 + (&builder - builders_.data()));
  record.op = {author, builder.instance, ++builder.seq};
  record.time_us = builder.due_us;
  record.edit = {SetVoxel{builder.at}, {}, builder.material};
  builder.due_us += rng_.between(120'000, 450'000);
  if (!builder.took_back && builder.material != kEmpty && rng_.below(25) == 0) {
    builder.took_back = true;  // empties the same voxel again
    builder.material = kEmpty;
    return record;
  }
  if (builder.took_back) {
    builder.took_back = false;
    builder.material = static_cast<Material>(1 + rng_.below(24));
  }
  advance(builder);
  if (rng_.below(3000) == 0) {
    builder.instance = rng_.next();
    builder.seq = 0;
    builder.due_us += 60'000'000;
  }
  return record;
}

}  // namespace runstone::test
