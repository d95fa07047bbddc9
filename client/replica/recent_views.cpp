#include "client/replica/recent_views.hpp"

namespace runstone {

void RecentViews::reopen() {
  before_.clear();
  since_ = 0;
}

void RecentViews::set(const View& view) {
  if (!current_) {
    since_ = view.number;
  } else if (!current_->same_chunks(view)) {
    if (since_ != view.number) {
      if (before_.size() == kRecentViewsMax) before_.erase(before_.begin());
      before_.push_back(*current_);
      before_.back().number = since_;
    }
    since_ = view.number;
  }
  current_ = view;
}

bool RecentViews::contains(const ChunkKey& key) const {
  return key.lod == 0 && current_ && current_->contains(key.at);
}

bool RecentViews::accepts(const ChunkKey& key, std::uint32_t number) const {
  if (!contains(key)) return false;
  std::uint32_t first = since_;
  for (auto view = before_.rbegin(); number < first && view != before_.rend(); ++view) {
    if (!view->contains(key.at)) return false;
    first = view->number;
  }
  return true;
}

}  // namespace runstone
