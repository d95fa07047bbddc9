// DrawThread: the thread that owns the screen. A frame may take long (a tenth of a second in
// software). Meanwhile changes are queued. So the main thread never waits, and applies, meshes and
// sends edits on time.
//   in    changes (meshes, removals, materials), of which the newest per chunk is kept, and at most
//         one frame order; bounded by the number of chunks
//   out   completed uploads and frames, in order; bounded by the number of orders since the last
//         take_done()
// The content of a frame:
//   - It shows every removal and all materials that were queued before its order.
//   - While no frame is ordered, meshes are uploaded one by one, in the order of UploadQueue. Once
//     a frame is ordered, uploads go on until the UploadBudget is spent, but at least one is made.
//     The rest is carried over to the next frames. So a burst of edits delays no frame by more than
//     the budget and one upload.
//   - A frame with FrameOrder::shows_all shows every change that was queued before its order,
//     however long the uploads take.
//   - A frame shows exactly the uploads that are reported as done before it.
// Queueing costs a lock and O(log queued changes).
// Threads: the main thread makes, calls and destroys it. `wake` is called from the draw thread.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "client/display/screen.hpp"
#include "client/display/upload_queue.hpp"
#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

struct FrameOrder {
  Camera camera;
  int width = 0, height = 0;  // pixels
  FrameContents contents;
  std::shared_ptr<const OverlayFrame> overlay;  // the user interface on top; null: none
  bool shows_all = false;                       // shows every change queued before the order
  std::vector<std::string> screenshots;         // PNG files to write of this frame
};

/// The bounds of the uploads before one frame. Either bound ends them.
struct UploadBudget {
  TimeUs time_us = 4'000;
  /// The time that a GPU takes to copy is not in the measured time.
  std::size_t bytes = std::size_t{8} << 20;
};

/// Times are those of steady_now_us().
struct UploadDone {
  ChunkKey key;
  std::uint64_t number = 0;  // as in ChunkUpload
  std::uint64_t serial = 0;
  TimeUs at_us = 0;
};
struct FrameDone {
  TimeUs started_us = 0, presented_us = 0;
  TimeUs upload_us = 0;     // that uploads took since the frame before
  std::size_t uploads = 0;  // since the frame before
  std::size_t carried = 0;  // uploads that were left for later frames
  RenderStats stats;
  std::vector<std::string> unwritten;  // screenshots that could not be written
};
using DrawDone = std::variant<UploadDone, FrameDone>;

enum class DrawPriority : std::uint8_t {
  normal,
  background,  // below the threads that apply and mesh; for off-screen frames
};

class DrawThread {
 public:
  /// Calls `make_screen` on the new thread. If that throws, throws std::runtime_error with the same
  /// text.
  DrawThread(std::function<std::unique_ptr<Screen>()> make_screen, DrawPriority priority,
             std::function<void()> wake, UploadBudget budget = {});
  /// Finishes the current frame and drops queued work.
  ~DrawThread();
  DrawThread(const DrawThread&) = delete;
  DrawThread& operator=(const DrawThread&) = delete;

  const std::string& screen_name() const { return name_; }

  void set_materials(const MaterialTable& materials);
  /// Queues new quads. They replace a queued change of the same chunk, which is then never reported
  /// as done.
  void upload(const ChunkKey& key, ChunkUpload upload);
  /// Queues a removal, which replaces a queued change of the same chunk.
  void remove(const ChunkKey& key);
  /// Drops queued work and what take_done() would return, waits for the frame in progress, and
  /// queues the removal of every chunk. So another world can be shown. Throws as take_done().
  void clear();
  /// Orders a frame. Requires that take_done() has returned the frame ordered before.
  void draw(FrameOrder order);

  /// Returns the uploads and frames completed since the last call. Throws std::runtime_error with
  /// the reason if drawing has failed.
  std::vector<DrawDone> take_done();
  /// Returns the number of queued changes.
  std::size_t waiting() const;

 private:
  struct Work {
    UploadQueue changes;
    std::optional<MaterialTable> materials;
    std::optional<FrameOrder> frame;
    bool empty() const { return changes.empty() && !materials && !frame; }
  };
  /// Uploads of which take_done() does not know yet, and what uploads took since the last frame.
  struct Uploads {
    std::vector<DrawDone> done;
    TimeUs us = 0;
    std::size_t count = 0;
  };
  enum class State : std::uint8_t { starting, drawing, failed };

  void run(const std::stop_token& stop, const std::function<std::unique_ptr<Screen>()>& make_screen,
           DrawPriority priority);
  void serve(const std::stop_token& stop, Screen& screen);
  /// Waits for work. Returns false if the thread is to end.
  bool await_work(const std::stop_token& stop);
  /// Gives the screen the queued materials and removals.
  void apply_removals(Screen& screen);
  /// Uploads while no frame is ordered.
  void upload_until_ordered(Screen& screen);
  /// Uploads what the frame shows. Returns the number of uploads that are carried over.
  std::size_t upload_for(const FrameOrder& order, Screen& screen);
  void upload(Screen& screen, const ChunkKey& key, const ChunkUpload& upload);
  void report_uploads();
  void done(std::vector<DrawDone> done);
  void fail(const char* why);

  const std::function<void()> wake_;
  const UploadBudget budget_;
  std::string name_;  // written before state_ becomes `drawing`, read after
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  State state_ = State::starting;  // guarded by mutex_, as are the next four
  std::string failure_;
  Work work_;
  std::vector<DrawDone> done_;
  bool is_busy_ = false;        // the draw thread uses work that it took
  Uploads uploads_;             // draw thread
  std::int32_t edge_ = 0;       // of the newest upload, voxels; draw thread
  bool frame_ordered_ = false;  // main thread
  std::set<ChunkKey> queued_;   // chunks that are on the screen or queued for it; main thread
  std::jthread thread_;         // last: it uses the members above
};

}  // namespace runstone
