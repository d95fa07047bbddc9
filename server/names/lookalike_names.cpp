#include "server/names/lookalike_names.hpp"

#include <algorithm>
#include <array>

#include "server/names/name_skeleton.hpp"

namespace runstone {
namespace {

constexpr std::array<std::string_view, 7> kListeners = {"all",  "anybody", "everybody", "everyone",
                                                        "here", "me",      "nobody"};

std::optional<std::string> found_in(const std::map<std::string, std::string>& names,
                                    const Skeletons& skeletons) {
  for (const std::string* skeleton : {&skeletons.written, &skeletons.folded}) {
    if (const auto found = names.find(*skeleton); found != names.end()) return found->second;
  }
  return std::nullopt;
}

}  // namespace

void LookalikeNames::add(const std::string& name, Compare compare) {
  for (const std::string& skeleton : protected_skeletons_of(name)) {
    whole_.try_emplace(skeleton, name);
    if (compare == Compare::words) words_.try_emplace(skeleton, name);
  }
}

std::optional<std::string> LookalikeNames::like(std::string_view name) const {
  if (auto whole = found_in(whole_, skeletons_of(name))) return whole;
  std::vector<Skeletons> words;
  for (const std::string& word : name_words(name)) words.push_back(skeletons_of(word));
  for (std::size_t first = 0; first < words.size(); ++first) {
    Skeletons joined;
    for (std::size_t last = first; last < words.size(); ++last) {
      joined.written += words[last].written;
      joined.folded += words[last].folded;
      if (auto part = found_in(words_, joined)) return part;
    }
  }
  return std::nullopt;
}

bool is_compared_whole(std::string_view name) {
  return std::find(kListeners.begin(), kListeners.end(), name) != kListeners.end();
}

}  // namespace runstone
