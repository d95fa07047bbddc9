// TextureExchange: how a client gets the textures of a world. The server sends the list of them;
// the pictures come from the client's cache, or else from the server. Every picture is checked:
//   - TextureTable bounds the list: 4,096 pictures, 16 MiB of PNG files, 64 MiB of pixels;
//   - the bytes must have the size and the hash of the list, whether the server or the cache gave
//     them; only then are they decoded (read_texture()), and only what is a picture is cached;
//   - a picture that fails is not asked for again on this connection. Its sides show the look of
//     their material.
// It makes the messages and takes the answers; ClientSession carries them. Pure. One thread.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/core/texture.hpp"
#include "common/textures/texture_picture.hpp"
#include "common/textures/texture_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

using TexturePicturePtr = std::shared_ptr<const TexturePicture>;

class TextureExchange {
 public:
  /// The hashes of one lookup in the cache.
  static constexpr std::size_t kLookupMax = 256;
  /// One call of step() decodes one picture, and further ones while all PNGs before are smaller
  /// together.
  static constexpr std::size_t kDecodeBytes = 32 * 1024;

  /// Sets whether pictures are wanted; they are not at first. The list is kept in any case.
  void set_wanted(bool is_wanted) { is_wanted_ = is_wanted; }
  /// Begins a connection. `has_textures`: the server has the feature. `has_cache`: take_lookup() is
  /// called. The list stays until the server sends a new one.
  void connected(bool has_textures, bool has_cache);
  void disconnected();
  /// Forgets everything, because the next world is another one.
  void clear();

  /// Takes a part of the list. Fails, with words for the server, if it is not valid.
  Result<void> receive(const TexturesGiven& given);
  /// Takes pictures. Pictures that were not requested change nothing.
  void receive(TextureParts answer);
  /// Decodes some of the pictures that arrived. Returns the messages to send now.
  std::vector<Message> step();

  /// Returns the hashes to look up in the cache, or nullopt if there are none.
  std::optional<std::vector<TextureHash>> take_lookup();
  /// Takes the result of the oldest lookup: the pictures that the cache found.
  void receive_cached(std::vector<TexturePart> found);
  /// Returns the pictures from the server that the cache should keep.
  std::vector<TexturePart> take_for_cache() { return std::exchange(for_cache_, {}); }

  /// Returns the list so far.
  const TextureTable& table() const { return table_; }
  /// Returns the picture, or null if it is not here.
  TexturePicturePtr picture(const TextureHash& hash) const;
  /// Returns true if pictures are under way, or wait to be decoded, looked up or asked for.
  bool is_loading() const;
  /// Returns the bytes of the pixels of all pictures that are here.
  std::size_t picture_bytes() const { return picture_bytes_; }
  /// Returns the pictures of this connection that were not what the list says, were no pictures, or
  /// were not sent.
  std::size_t failed() const { return failed_; }
  /// Returns a number that rises with each change of table() and picture().
  std::uint64_t serial() const { return serial_; }

 private:
  enum class State : std::uint8_t { listed, looked_up, missing, asked, arrived, here, failed };
  struct Slot {
    State state = State::listed;
    std::uint32_t bytes = 0;  // of the list
    TexturePicturePtr picture;
  };
  struct Arrival {
    TexturePart part;
    bool is_from_cache = false;
  };

  bool asks() const { return is_wanted_ && has_textures_ && !is_list_new_; }
  void move_to(Slot& slot, State next);
  std::size_t count(State state) const { return counts_[static_cast<std::size_t>(state)]; }
  /// Forgets the pictures in this state, or nullopt: in any, that are not in the list.
  void forget_unlisted(std::optional<State> state);
  void decode(Arrival arrival);
  /// Returns up to `most` hashes in this state, and moves them to the next one.
  std::vector<TextureHash> take(State from, State next, std::size_t most);

  bool is_wanted_ = false, has_textures_ = false, has_cache_ = false;
  bool is_list_new_ = false;  // the next part of the list is its first
  TextureTable table_;
  std::map<TextureHash, Slot> slots_;
  std::array<std::size_t, static_cast<std::size_t>(State::failed) + 1> counts_{};  // slots by state
  std::deque<std::vector<TextureHash>> lookups_;  // that have no result yet
  std::deque<Arrival> arrived_;                   // to be decoded
  std::vector<TexturePart> for_cache_;
  std::size_t picture_bytes_ = 0;
  std::size_t failed_ = 0;
  std::uint64_t serial_ = 0;
};

/// Passes lookups, their results and new pictures between the textures of a session and its cache.
/// `cache` is a CacheThread or a WebCache. Call it every turn.
template <typename Cache>
void exchange_textures(TextureExchange& textures, Cache& cache) {
  for (auto& found : cache.drain_textures()) textures.receive_cached(std::move(found));
  while (auto hashes = textures.take_lookup()) cache.look_up_textures(*std::move(hashes));
  if (auto parts = textures.take_for_cache(); !parts.empty()) cache.keep_textures(std::move(parts));
}

}  // namespace runstone
