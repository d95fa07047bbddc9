#include "server/world/people/player_places.hpp"

namespace runstone {

void PlayerPlaces::restore(const std::vector<LastPlace>& saved) {
  numbers_.clear();
  places_.clear();
  for (const LastPlace& place : saved) note(place.key, place.pose);
}

void PlayerPlaces::note(const PublicKey& key, const Pose& pose) {
  const auto [number, is_new] = numbers_.try_emplace(key);
  if (!is_new) places_.erase(number->second);
  number->second = ++newest_;
  places_[newest_] = {key, pose};
  if (places_.size() <= kPlayerPlacesMax) return;
  numbers_.erase(places_.begin()->second.key);
  places_.erase(places_.begin());
}

std::optional<Pose> PlayerPlaces::find(const PublicKey& key) const {
  const auto number = numbers_.find(key);
  if (number == numbers_.end()) return std::nullopt;
  return places_.at(number->second).pose;
}

std::vector<LastPlace> PlayerPlaces::all() const {
  std::vector<LastPlace> out;
  out.reserve(places_.size());
  for (const auto& [number, place] : places_) out.push_back(place);
  return out;
}

}  // namespace runstone
