// DrawQueue: what the main thread hands to the screen, and what it gets back.
//   in    changes (meshes, removals, materials, textures), of which the newest per chunk is kept,
//         and at most one frame order; bounded by the number of chunks
//   out   completed uploads and frames, in order; bounded by the number of orders since the last
//         take_done()
// The content of a frame:
//   - It shows every removal, all materials and all textures that were queued before its order.
//   - While no frame is ordered, meshes are uploaded one by one, in the order of UploadQueue. Once
//     a frame is ordered, uploads go on until the UploadBudget is spent, but at least one is made.
//     The rest is carried over to the next frames. So a burst of edits delays no frame by more than
//     the budget and one upload.
//   - A frame with FrameOrder::shows_all shows every change that was queued before its order,
//     however long the uploads take.
//   - A frame shows exactly the uploads that are reported as done before it.
// Queueing costs a lock and O(log queued changes).
// Threads: one thread queues, takes what is done and destroys the queue; one thread calls serve().
// In a window these are two threads (DrawThread). In a browser they are the same one.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "client/display/screen.hpp"
#include "client/display/upload_queue.hpp"
#include "client/render/drawn_textures.hpp"
#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"
#include "common/shapes/shape_table.hpp"

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
  /// The errors of screenshots that could not be written. Each begins with the name of the file.
  std::vector<std::string> unwritten;
};
using DrawDone = std::variant<UploadDone, FrameDone>;

class DrawQueue {
 public:
  /// `wake` is called from the thread that draws, after each new result; it may be null.
  explicit DrawQueue(std::function<void()> wake, UploadBudget budget = {});
  virtual ~DrawQueue() = default;
  DrawQueue(const DrawQueue&) = delete;
  DrawQueue& operator=(const DrawQueue&) = delete;

  /// Returns the name of the screen's OpenGL context. Requires that set_drawing() was called.
  const std::string& screen_name() const { return name_; }

  /// Queues materials. `shapes` are their shapes; null: the thread that draws makes them.
  void set_materials(const MaterialTable& materials, ShapeTablePtr shapes = nullptr);
  /// Queues the textures of the world. A null pointer means that there are none.
  void set_textures(DrawnTexturesPtr textures);
  /// Queues new quads. They replace a queued change of the same chunk, which is then never reported
  /// as done.
  void upload(const ChunkKey& key, ChunkUpload upload);
  /// Queues a removal, which replaces a queued change of the same chunk.
  void remove(const ChunkKey& key);
  /// Drops queued work and what take_done() would return, waits for the frame in progress, and
  /// queues the removal of every chunk and of the textures. So another world can be shown. Throws
  /// as take_done().
  void clear();
  /// Orders a frame. Requires that take_done() has returned the frame ordered before.
  void draw(FrameOrder order);

  /// Returns the uploads and frames completed since the last call. Throws std::runtime_error with
  /// the reason if drawing has failed.
  std::vector<DrawDone> take_done();
  /// Returns the number of queued changes.
  std::size_t waiting() const;

  // The side that draws.

  /// Reports that there is a screen, on which serve() draws from now on.
  void set_drawing(const char* screen_name);
  /// Gives the screen the queued materials, textures and removals, and draws the frame that is
  /// ordered. If none is, uploads for a while.
  void serve(Screen& screen);
  /// Reports that drawing has failed, and why.
  void fail(const char* why);

 protected:
  /// Waits for work. Returns false if the thread that draws is to end.
  bool await_work();
  /// Lets await_work() return false from now on.
  void stop();
  /// Waits until set_drawing() or fail() was called. Throws std::runtime_error with the reason if
  /// it was fail().
  void await_start();

 private:
  struct Materials {
    MaterialTable table;
    ShapeTablePtr shapes;
  };
  struct Work {
    UploadQueue changes;
    std::optional<Materials> materials;
    std::optional<DrawnTexturesPtr> textures;
    std::optional<FrameOrder> frame;
    bool empty() const { return changes.empty() && !materials && !textures && !frame; }
  };
  /// Uploads of which take_done() does not know yet, and what uploads took since the last frame.
  struct Uploads {
    std::vector<DrawDone> done;
    TimeUs us = 0;
    std::size_t count = 0;
  };
  enum class State : std::uint8_t { starting, drawing, failed };

  /// Gives the screen the queued materials, textures and removals.
  void apply_removals(Screen& screen);
  /// Uploads while no frame is ordered.
  void upload_until_ordered(Screen& screen);
  /// Uploads what the frame shows. Returns the number of uploads that are carried over.
  std::size_t upload_for(const FrameOrder& order, Screen& screen);
  void upload(Screen& screen, const ChunkKey& key, const ChunkUpload& upload);
  void report_uploads();
  void done(std::vector<DrawDone> done);

  const std::function<void()> wake_;
  const UploadBudget budget_;
  std::string name_;  // written before state_ becomes `drawing`, read after
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  State state_ = State::starting;  // guarded by mutex_, as are the next five
  std::string failure_;
  Work work_;
  std::vector<DrawDone> done_;
  bool is_busy_ = false;  // the side that draws uses work that it took
  bool stops_ = false;
  Uploads uploads_;             // of the side that draws
  std::int32_t edge_ = 0;       // of the newest upload, voxels; of the side that draws
  bool frame_ordered_ = false;  // of the side that queues
  bool has_textures_ = false;   // the newest textures that were queued are some; of that side
  std::set<ChunkKey> queued_;   // chunks that are on the screen or queued for it; of that side
};

}  // namespace runstone
