#include "client/display/draw_program.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "client/display/drawn_world.hpp"
#include "client/render/png_file.hpp"
#include "client/report/exit_code.hpp"
#include "common/os/low_priority.hpp"
#include "common/os/steady_clock.hpp"
#include "protocol/codec/draw_answer.hpp"
#include "protocol/codec/draw_order.hpp"

namespace runstone {
namespace {

constexpr std::size_t kReadBytes = 64 * 1024;

Camera camera_of(const DrawCamera& from) {
  Camera camera;
  camera.x = from.x;
  camera.y = from.y;
  camera.z = from.z;
  camera.yaw = from.yaw;
  camera.pitch = from.pitch;
  camera.fov_y = from.fov_y;
  camera.near = from.near;
  camera.far = from.far;
  return camera;
}

class DrawService {
 public:
  DrawService(int orders, int answers, unsigned workers, Screen& screen)
      : orders_(orders), answers_(answers), workers_(workers), screen_(screen) {}

  int serve() {
    if (!send(DrawReady{kDrawVersion, screen_.name()})) return kExitNoStart;
    std::array<std::uint8_t, kReadBytes> buffer;
    while (!reader_.ended()) {
      const ssize_t got = ::read(orders_, buffer.data(), buffer.size());
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return refuse(std::string("cannot read the orders: ") + std::strerror(errno));
      const auto taken =
          got == 0 ? reader_.finish()
                   : reader_.feed({buffer.data(), static_cast<std::size_t>(got)},
                                  [this](DrawOrder order) { return take(std::move(order)); });
      if (!taken) {
        return refuse(std::string(taken.error().what) + ", at byte " +
                      std::to_string(taken.error().offset));
      }
    }
    return code_;
  }

 private:
  Result<void> take(DrawOrder order) {
    return std::visit([this](auto& o) { return take_one(o); }, order);
  }
  Result<void> take_one(const DrawWorld& world) {
    world_.emplace(screen_, world.edge, world.materials, workers_);
    return {};
  }
  Result<void> take_one(DrawChunk& chunk) {
    if (world_->put(chunk.key, std::move(chunk.voxels))) return {};
    return fail(ErrorCode::limit_exceeded, "draw order: more chunks than the program holds");
  }
  Result<void> take_one(const DrawForget& forget) {
    world_->forget(forget.key);
    return {};
  }
  Result<void> take_one(const DrawPicture& picture) {
    const TimeUs start = steady_now_us();
    const RenderStats stats =
        world_->draw(camera_of(picture.camera), picture.size.width, picture.size.height);
    if (const auto written = write_png(picture.file, screen_.read_image()); !written) {
      code_ = kExitFailed;
      return answer(PictureUnwritten{written.error()});
    }
    const auto took = static_cast<std::uint64_t>(steady_now_us() - start);
    return answer(PictureDrawn{stats.quads_drawn, stats.chunks_drawn, took, picture.file});
  }
  Result<void> take_one(const DrawEnd&) { return {}; }

  Result<void> answer(const DrawAnswer& answer) {
    if (send(answer)) return {};
    return fail(ErrorCode::io_failed, "draw order: nobody reads the answers");
  }
  int refuse(const std::string& why) {
    send(DrawFailed{why});
    return kExitNoStart;
  }
  /// Writes an answer. Returns false if it cannot be written.
  bool send(const DrawAnswer& answer) {
    const std::string line = to_line(answer);
    std::size_t done = 0;
    while (done < line.size()) {
      const ssize_t put = ::write(answers_, line.data() + done, line.size() - done);
      if (put < 0 && errno != EINTR) return false;
      if (put > 0) done += static_cast<std::size_t>(put);
    }
    return true;
  }

  const int orders_, answers_;
  const unsigned workers_;
  Screen& screen_;
  DrawOrderReader reader_;
  std::optional<DrawnWorld> world_;  // set by the first order
  int code_ = kExitOk;
};

void send_failure(int answers, const std::string& why) {
  const std::string line = to_line(DrawFailed{why});
  // If this write fails, the exit code still reports the failure.
  static_cast<void>(!::write(answers, line.data(), line.size()));
}

}  // namespace

int draw_program(int orders, int answers, unsigned workers,
                 const std::function<std::unique_ptr<Screen>()>& make_screen) {
  try {
    lower_priority();
    const std::unique_ptr<Screen> screen = make_screen();
    return DrawService(orders, answers, workers, *screen).serve();
  } catch (const std::exception& error) {
    send_failure(answers, error.what());
    return kExitNoStart;
  }
}

}  // namespace runstone
