#include "client/play/server_notices.hpp"

#include <utility>

#include "common/core/text.hpp"

namespace runstone {

std::vector<PlayerNotice> ServerNotices::take_state() {
  std::vector<PlayerNotice> out;
  if (session_.history_refusal() != told_refusal_) {
    told_refusal_ = session_.history_refusal();
    if (!told_refusal_.empty())
      out.push_back(
          {"the past is not shown: " + with_unseen_replaced(told_refusal_), NoticeKind::warning});
  }
  const bool is_read_only = session_.is_server_read_only();
  if (std::exchange(told_read_only_, is_read_only) != is_read_only) {
    out.push_back({is_read_only ? "the server is read-only: it cannot write edits to its disk now"
                                : "the server accepts edits again",
                   is_read_only ? NoticeKind::warning : NoticeKind::information});
  }
  return out;
}

PlayerNotice notice_of(const RejectedEdit& reject) {
  return {std::string("the server refused an edit: ") + to_string(reject.reason) + ' ' +
              with_unseen_replaced(reject.detail),
          NoticeKind::warning};
}

}  // namespace runstone
