#include "client/app/preview_exchange.hpp"

namespace runstone {

bool PreviewExchange::step(const ClientSettings& settings, TimeUs now_us) {
  static const std::vector<EditDescriptor> kNothing;
  const bool is_on = tool_.box().is_preview_shown();
  const bool is_shared = is_on && settings.shares_previews && tool_.has_preview();
  session_.share_preview(is_shared ? tool_.box().preview().edits() : kNothing, now_us);
  const Replica& replica = session_.replica();
  if (!is_on || !settings.shows_previews || !replica.opened() || replica.past())
    return others_.clear();
  return others_.step(replica, session_.others_previews());
}

}  // namespace runstone
