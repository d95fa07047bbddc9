// DrawThread: the thread that owns the screen. A frame may take long (a tenth of a second in software); what
// changes meanwhile waits here, so that the main thread never does: edits are applied, meshed and sent on
// time.
//   in    changes (meshes, removals, materials), the newest of each chunk, and at most one frame order;
//         bounded by the number of chunks
//   out   what was done, in its order; bounded by what went in since it was last taken
// A frame shows every change that was handed over before its order. Hand-overs cost a lock and a map
// insertion. Threads: made, called and destroyed by the main thread; `wake` is called from the draw thread.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "client/display/screen.hpp"
#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// A chunk's new quads. `serial`: Replica::shown_serial() of what was meshed.
struct ChunkUpload {
  std::uint64_t serial = 0;
  std::int32_t edge = 0;  // voxels
  std::shared_ptr<const ChunkMesh> mesh;
};

struct FrameOrder {
  Camera camera;
  int width = 0, height = 0;  // pixels
  std::vector<Marker> markers;
  std::vector<std::string> screenshots;  // PNG files that this frame becomes
};

/// Times are of steady_now_us().
struct UploadDone {
  ChunkKey key;
  std::uint64_t serial = 0;
  TimeUs at_us = 0;
};
struct FrameDone {
  TimeUs started_us = 0, presented_us = 0;
  RenderStats stats;
  std::vector<std::string> unwritten;  // screenshots that could not be written
};
using DrawDone = std::variant<UploadDone, FrameDone>;

enum class DrawPriority : std::uint8_t {
  normal,
  background,  // below the threads that apply and mesh, for pictures that nobody watches
};

class DrawThread {
 public:
  /// `make_screen` is called on the new thread; its exception is thrown here, as std::runtime_error.
  DrawThread(std::function<std::unique_ptr<Screen>()> make_screen, DrawPriority priority,
             std::function<void()> wake);
  /// Lets a frame under way end; drops what waits.
  ~DrawThread();
  DrawThread(const DrawThread&) = delete;
  DrawThread& operator=(const DrawThread&) = delete;

  const std::string& screen_name() const { return name_; }

  void set_materials(const MaterialTable& materials);
  /// Replaces a waiting change of this chunk, which is then never done.
  void upload(const ChunkKey& key, ChunkUpload upload);
  void remove(const ChunkKey& key);
  /// Requires that the frame ordered before is among the done ones taken.
  void draw(FrameOrder order);

  /// What was done since the last call. Throws std::runtime_error with the reason once drawing has failed.
  std::vector<DrawDone> take_done();
  /// Changes that wait.
  std::size_t waiting() const;

 private:
  struct Work {
    std::map<ChunkKey, std::optional<ChunkUpload>> changes;  // none: remove the chunk
    std::optional<MaterialTable> materials;
    std::optional<FrameOrder> frame;
    bool empty() const { return changes.empty() && !materials && !frame; }
  };
  enum class State : std::uint8_t { starting, drawing, failed };

  void run(const std::stop_token& stop, const std::function<std::unique_ptr<Screen>()>& make_screen,
           DrawPriority priority);
  void serve(const std::stop_token& stop, Screen& screen);
  std::optional<Work> next(const std::stop_token& stop);
  void done(std::vector<DrawDone> done);
  void fail(const char* why);

  const std::function<void()> wake_;
  std::string name_;  // written before `drawing`, read after
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  State state_ = State::starting;  // guarded by mutex_, as are the next three
  std::string failure_;
  Work work_;
  std::vector<DrawDone> done_;
  bool frame_ordered_ = false;  // main thread
  std::jthread thread_;         // last: it uses what is above
};

}  // namespace runstone
