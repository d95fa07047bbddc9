#include "client/session/voxel_author.hpp"

#include <algorithm>
#include <utility>

namespace runstone {

const VoxelAuthor::Kept* VoxelAuthor::kept(const Sight& sight) const {
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& each) {
    return each.sight.at == sight.at && each.sight.material == sight.material;
  });
  return found == kept_.end() ? nullptr : &*found;
}

std::optional<LogMarksRequest> VoxelAuthor::look(const std::optional<Sight>& sight, bool may_send,
                                                 TimeUs now_us) {
  if (pending_ && now_us - pending_->sent_us >= kAnswerUsMax) pending_.reset();
  const bool is_same = sight && sight_ && sight->at == sight_->at;
  if (!is_same) rests_since_us_ = now_us;
  const bool shows_same = is_same && sight->material == sight_->material;
  if (!shows_same && (sight || sight_)) has_changed_ = true;
  sight_ = sight;
  if (!sight || pending_ || !may_send || now_us - rests_since_us_ < kRestUs) return std::nullopt;
  if (sent_us_ && now_us - *sent_us_ < kEveryUs) return std::nullopt;
  const Kept* const known = kept(*sight);
  if (known != nullptr && known->sight.version == sight->version) return std::nullopt;
  sent_us_ = now_us;
  pending_ = Pending{next_request_, *sight, now_us};
  next_request_ = std::max(next_request_ + 1, kFirstRequest);
  return LogMarksRequest{pending_->request, 1, kSequenceMax, 1, sight->at};
}

bool VoxelAuthor::receive(const LogMarks& marks) {
  if (!pending_ || pending_->request != marks.request) return false;
  Kept answer{std::exchange(pending_, std::nullopt)->sight, std::nullopt};
  if (!marks.marks.empty()) {
    const LogMark& mark = marks.marks.back();
    std::string name = mark.author == 0 ? "the server" : "#" + std::to_string(mark.author);
    for (const LogAuthor& author : marks.authors) {
      if (author.author == mark.author) name = author.name;
    }
    answer.found = Found{mark, std::move(name)};
  }
  std::erase_if(kept_, [&](const Kept& each) { return each.sight.at == answer.sight.at; });
  kept_.push_front(std::move(answer));
  if (kept_.size() > kKeptMax) kept_.pop_back();
  has_changed_ = true;
  return true;
}

const VoxelAuthor::Found* VoxelAuthor::found() const {
  const Kept* const known = sight_ ? kept(*sight_) : nullptr;
  return known != nullptr && known->found ? &*known->found : nullptr;
}

}  // namespace runstone
