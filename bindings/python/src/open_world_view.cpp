#include "open_world_view.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "server/history/voxels_at.hpp"
#include "server/store/world_folder.hpp"

namespace runstone::python {
namespace {

Unexpected<ViewError> view_failure(const StoreError& error) {
  const bool is_request = error.kind == StoreError::Kind::bad_request;
  return failure(ViewError{is_request ? ViewError::Kind::bad_request : ViewError::Kind::unreadable,
                           error.message()});
}

Unexpected<ViewError> unreadable(std::string text) {
  return failure(ViewError{ViewError::Kind::unreadable, std::move(text)});
}

}  // namespace

ViewResult<std::shared_ptr<OpenWorldView>> OpenWorldView::open(
    const std::string& place, const std::optional<NamedMoment>& moment) {
  std::shared_ptr<OpenWorldView> view(new OpenWorldView(place, moment.has_value()));
  if (auto added = view->add_reader(); !added) return failure(added.error());
  Store& store = *view->readers_.front();
  view->meta_ = store.meta();
  auto generator = generator_of(store);
  if (!generator) return unreadable(generator.error());
  view->generator_ = *std::move(generator);
  const auto at = moment ? sequence_of(store, *moment) : store.last_sequence();
  if (!at) return view_failure(at.error());
  if (auto opened = view->reopen(*at); !opened) return failure(opened.error());
  return view;
}

ViewResult<std::shared_ptr<OpenWorldView>> OpenWorldView::at(const NamedMoment& moment) {
  if (auto is_open = require_open(); !is_open) return failure(is_open.error());
  return open(place_, moment);
}

void OpenWorldView::close() {
  const std::lock_guard lock(mutex_);
  world_.reset();
  generator_.reset();
  readers_.clear();
}

bool OpenWorldView::is_closed() {
  const std::lock_guard lock(mutex_);
  return readers_.empty();
}

ViewResult<void> OpenWorldView::require_open() {
  const std::lock_guard lock(mutex_);
  return check_open();
}

ViewResult<void> OpenWorldView::add_reader() {
  auto store = open_world(place_, StoreAccess::read_only);
  if (!store) return view_failure(store.error());
  readers_.push_back(*std::move(store));
  return {};
}

ViewResult<void> OpenWorldView::check_open() const {
  if (!readers_.empty()) return {};
  return failure(ViewError{ViewError::Kind::closed, place_name(place_) + ": the world is closed"});
}

ViewResult<void> OpenWorldView::reopen(Sequence at) {
  auto world = WorldAt::open(*readers_.front(), *generator_, at);
  if (!world) return view_failure(world.error());
  world_.emplace(*std::move(world));
  return {};
}

ViewResult<void> OpenWorldView::refresh() {
  if (auto is_open = check_open(); !is_open) return is_open;
  if (is_pinned_) return {};
  const auto last = readers_.front()->last_sequence();
  if (!last) return view_failure(last.error());
  if (*last == world_->at()) return {};
  if (const auto advanced = world_->advance(*last); advanced) return {};
  return reopen(*last);
}

ViewResult<LogEnd> OpenWorldView::end() {
  const std::lock_guard lock(mutex_);
  if (auto ready = refresh(); !ready) return failure(ready.error());
  return world_->end();
}

ViewResult<std::string> OpenWorldView::loss() {
  const std::lock_guard lock(mutex_);
  if (auto is_open = check_open(); !is_open) return failure(is_open.error());
  const auto& loss = readers_.front()->loss();
  return loss ? loss->message() : std::string();
}

ViewResult<MaterialTable> OpenWorldView::materials() {
  const std::lock_guard lock(mutex_);
  if (auto ready = refresh(); !ready) return failure(ready.error());
  auto table = readers_.front()->materials(world_->at());
  if (!table) return view_failure(table.error());
  return *std::move(table);
}

ViewResult<std::vector<PlayerRow>> OpenWorldView::players() {
  const std::lock_guard lock(mutex_);
  if (auto is_open = check_open(); !is_open) return failure(is_open.error());
  auto rows = readers_.front()->players();
  if (!rows) return view_failure(rows.error());
  return *std::move(rows);
}

ViewResult<Chunk> OpenWorldView::chunk(ChunkCoord at) {
  const std::lock_guard lock(mutex_);
  if (auto ready = refresh(); !ready) return failure(ready.error());
  auto chunk = world_->chunk({0, at});
  if (!chunk) return view_failure(chunk.error());
  return *std::move(chunk);
}

ViewResult<void> OpenWorldView::voxels(const VoxelBox& box, std::span<Material> out) {
  const std::lock_guard lock(mutex_);
  if (auto ready = refresh(); !ready) return ready;
  // A small box is read before another thread has started.
  const auto edge = static_cast<std::size_t>(meta_.chunk_edge);
  const std::size_t chunks = out.size() / (edge * edge * edge) + 1;
  const std::size_t wanted = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1,
                                                     std::min(kThreadsMax, chunks / 8 + 1));
  while (readers_.size() < wanted) {
    if (auto added = add_reader(); !added) return added;
  }
  std::vector<WorldReader*> readers;
  for (std::size_t i = 0; i < wanted; ++i) readers.push_back(readers_[i].get());
  const auto read = read_voxels(*world_, readers, box, out);
  if (!read) return view_failure(read.error());
  return {};
}

ViewResult<std::vector<EditRecord>> OpenWorldView::records(Sequence first, Sequence last,
                                                           std::size_t count) {
  const std::lock_guard lock(mutex_);
  if (auto ready = refresh(); !ready) return failure(ready.error());
  std::vector<EditRecord> out;
  const auto read = readers_.front()->read_log(first, std::min(last, world_->at()),
                                               [&](const EditRecord& record) {
                                                 out.push_back(record);
                                                 return out.size() < count;
                                               });
  if (!read) return view_failure(read.error());
  return out;
}

}  // namespace runstone::python
