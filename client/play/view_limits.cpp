#include "client/play/view_limits.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace runstone {
namespace {

/// A view whose chunks have been here for this long is taken as meshed.
constexpr TimeUs kMeshedUs = 2'000'000;

std::size_t far_bytes_max(const ViewWishes& wishes) {
  return wishes.far_levels == 0 ? 0 : (wishes.memory_mib << 20) / 8;
}

std::string shortage(const std::string& what, unsigned here, unsigned wanted,
                     const std::string& unit) {
  return what + ' ' + std::to_string(here) + " of " + std::to_string(wanted) + ' ' + unit +
         ", because memory is short";
}

}  // namespace

ViewLimits::ViewLimits(const ViewWishes& wishes, const Replica& replica, MeshPipeline& pipeline,
                       ViewFollower& view)
    : wishes_(wishes),
      replica_(replica),
      pipeline_(pipeline),
      view_(view),
      far_(far_bytes_max(wishes), wishes.far_levels),
      budget_((wishes.memory_mib << 20) - far_bytes_max(wishes), wishes.radii) {}

void ViewLimits::open_world(std::uint8_t radius_max) {
  budget_.set_wanted(
      {std::min(wishes_.radii.h, radius_max), std::min(wishes_.radii.v, radius_max)});
  // The levels that help depend on the edge of the chunks, which is known from now on.
  if (view_.radii() != budget_.radii() || wishes_.far_levels != 0) view_.set_radii(budget_.radii());
}

bool ViewLimits::is_meshed(TimeUs now_us) const {
  const auto complete_since_us = view_.complete_since_us();
  return complete_since_us && now_us - *complete_since_us >= kMeshedUs;
}

std::optional<LimitChange> ViewLimits::limit_view(TimeUs now_us) {
  const MemoryUse before = use();
  const ViewRadii was = budget_.radii();
  if (!budget_.step(before, is_meshed(now_us), now_us)) return std::nullopt;
  const ViewRadii now = budget_.radii(), wanted = budget_.wanted();
  view_.set_radii(now);
  pipeline_.view_changed();
  const bool has_shrunk = now.h + now.v < was.h + was.v;
  return LimitChange{
      fmt::format("memory: {} of {} MiB in use; the view {} to radius {} of {} chunks, {} of {} "
                  "vertically",
                  before.total() >> 20, budget_.bytes_max() >> 20, has_shrunk ? "shrinks" : "grows",
                  now.h, wanted.h, now.v, wanted.v),
      has_shrunk};
}

void ViewLimits::limit_meshes() {
  const MemoryUse kept = use();
  pipeline_.set_mesh_bytes_max(budget_.room(kept) + kept.meshes + kept.gpu);
}

std::optional<LimitChange> ViewLimits::limit_far(TimeUs now_us) {
  const std::size_t before = pipeline_.far_bytes();
  const std::uint8_t was = far_.levels();
  const bool is_complete = is_meshed(now_us) && pipeline_.is_far_meshed();
  if (!far_.step(before, is_complete, now_us)) return std::nullopt;
  view_.set_far_levels(far_.levels());
  const bool has_shrunk = far_.levels() < was;
  return LimitChange{
      fmt::format("memory: {} of {} MiB in use by far ground, which {} to {} of {} levels",
                  before >> 20, far_.bytes_max() >> 20, has_shrunk ? "shrinks" : "grows",
                  far_.levels(), far_.wanted()),
      has_shrunk};
}

MemoryUse ViewLimits::use() const {
  return {replica_.chunk_bytes(), replica_.local_edits().bytes(), pipeline_.mesh_bytes(),
          pipeline_.gpu_bytes(), texture_bytes_};
}

std::string ViewLimits::text() const {
  if (budget_.binds()) return shortage("view", budget_.radii().h, budget_.wanted().h, "chunks");
  if (far_.binds()) return shortage("far ground:", far_.levels(), far_.wanted(), "levels");
  return {};
}

void ViewLimits::add_to(ClientReport& report, const View& view, double reach) const {
  report.memory = use();
  report.budget = report_of(budget_);
  set_far_budget(report.far, far_);
  report.far.levels = view.levels;
  report.far.reach = reach;
}

}  // namespace runstone
