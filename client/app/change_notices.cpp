#include "client/app/change_notices.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "common/core/key_text.hpp"

namespace runstone {

void ChangeNotices::warn(const std::string& text) {
  spdlog::warn("{}", text);
  hud_.notify(text, NoticeKind::warning);
}

void ChangeNotices::take(const ReplicaChanges& changes) {
  for (const auto& [key, reason] : changes.unavailable)
    spdlog::warn("chunk={} unavailable: {}", text_of(key), to_string(reason));
  if (session_.history_refusal() != told_refusal_) {
    told_refusal_ = session_.history_refusal();
    if (!told_refusal_.empty()) warn("the past is not shown: " + told_refusal_);
  }
  const bool is_read_only = session_.is_server_read_only();
  if (std::exchange(told_read_only_, is_read_only) != is_read_only) {
    if (is_read_only) {
      warn("the server is read-only: its disk is full");
    } else {
      spdlog::warn("the server accepts edits again");
      hud_.notify("the server accepts edits again");
    }
  }
  for (const RejectedEdit& reject : changes.rejects) {
    spdlog::info("edit={} rejected: {} {}", reject.seq, to_string(reject.reason), reject.detail);
    hud_.notify(
        fmt::format("the server refused an edit: {} {}", to_string(reject.reason), reject.detail),
        NoticeKind::warning);
  }
}

}  // namespace runstone
