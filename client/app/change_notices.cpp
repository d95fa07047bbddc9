#include "client/app/change_notices.hpp"

#include <spdlog/spdlog.h>

#include "common/core/key_text.hpp"

namespace runstone {

void ChangeNotices::show(const ServerNotice& notice) {
  hud_.notify(notice.text, notice.is_warning ? NoticeKind::warning : NoticeKind::information);
}

void ChangeNotices::take(const ReplicaChanges& changes) {
  for (const auto& [key, reason] : changes.unavailable)
    spdlog::warn("chunk={} unavailable: {}", text_of(key), to_string(reason));
  for (const ServerNotice& notice : notices_.take_state()) {
    spdlog::warn("{}", notice.text);
    show(notice);
  }
  for (const RejectedEdit& reject : changes.rejects) {
    spdlog::info("edit={} rejected: {} {}", reject.seq, to_string(reject.reason), reject.detail);
    show(notice_of(reject));
  }
}

}  // namespace runstone
