// PlayerPlaces: where players were last in the world, by their keys. A player joins there. Bound:
// kPlayerPlacesMax; the place of the player who was seen longest ago is forgotten.
// Thread: the world strand.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "server/world/environment/saved_state.hpp"

namespace runstone {

class PlayerPlaces {
 public:
  explicit PlayerPlaces(const std::vector<LastPlace>& saved) { restore(saved); }

  /// Replaces all places.
  void restore(const std::vector<LastPlace>& saved);
  /// Notes that the player is here now.
  void note(const PublicKey& key, const Pose& pose);
  std::optional<Pose> find(const PublicKey& key) const;
  /// Returns all places, those noted last at the end.
  std::vector<LastPlace> all() const;

 private:
  std::map<PublicKey, std::uint64_t> numbers_;  // of the entry in places_
  std::map<std::uint64_t, LastPlace> places_;   // ascending by when they were noted
  std::uint64_t newest_ = 0;
};

}  // namespace runstone
