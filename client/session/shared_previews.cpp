#include "client/session/shared_previews.hpp"

namespace runstone {

void SharedPreviews::receive(PlayerPreview preview, std::int32_t chunk_edge, TimeUs now_us) {
  if (preview.edits.empty() || !may_be_shared(preview.edits, chunk_edge))
    return forget(preview.author);
  if (others_.size() >= kAuthorsMax && !others_.contains(preview.author)) return;
  if (preview.stroke && !check_stroke(*preview.stroke)) preview.stroke.reset();
  others_[preview.author] = {std::move(preview.edits), now_us, std::move(preview.stroke)};
}

void SharedPreviews::forget_stroke(AuthorId author) {
  const auto found = others_.find(author);
  if (found != others_.end() && found->second.stroke) others_.erase(found);
}

void SharedPreviews::reset() {
  others_.clear();
  sent_ = {};
  sent_us_.reset();
  unfit_us_.reset();
}

void SharedPreviews::expire(TimeUs now_us) {
  std::erase_if(others_, [now_us](const auto& entry) {
    return now_us - entry.second.received_us >= kShownUs;
  });
}

std::optional<PreviewShare> SharedPreviews::share(const std::vector<EditDescriptor>& edits,
                                                  std::int32_t chunk_edge, TimeUs now_us,
                                                  const std::optional<BrushStroke>& stroke) {
  if (sent_us_ && now_us - *sent_us_ < kEveryUs) return std::nullopt;
  if (edits.empty() && sent_.edits.empty()) return std::nullopt;
  if (unfit_us_ && now_us - *unfit_us_ < kEveryUs) return std::nullopt;
  const bool is_shared = may_be_shared(edits, chunk_edge);
  unfit_us_ = is_shared ? std::nullopt : std::optional(now_us);
  PreviewShare wanted;
  if (is_shared) wanted.edits = edits;
  if (!wanted.edits.empty() && stroke && check_stroke(*stroke)) wanted.stroke = stroke;
  const bool is_due = !wanted.edits.empty() && (!sent_us_ || now_us - *sent_us_ >= kRepeatUs);
  if (wanted == sent_ && !is_due) return std::nullopt;
  sent_ = wanted;
  sent_us_ = now_us;
  return wanted;
}

}  // namespace runstone
