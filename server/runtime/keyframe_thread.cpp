#include "server/runtime/keyframe_thread.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "server/runtime/logging.hpp"
#include "server/runtime/writer_answer.hpp"
#include "server/store/store.hpp"

namespace runstone {

namespace {

// The thread reads the log in portions of so many edits, or up to the place where a keyframe may be
// due. So a commit of one edit does not wake it.
constexpr Sequence kPortionEdits = 1024;

// The number of times that a keyframe is begun again because retention moved the beginning of the
// log meanwhile, and the rest before each attempt. This happens only to a keyframe without an
// earlier keyframe.
constexpr int kOutrunsMax = 100;
constexpr std::chrono::seconds kOutrunRest{1};

}  // namespace

KeyframeThread::KeyframeThread(std::string place, const Generator& generator,
                               const KeyframePolicy& policy, LogWriter& writer)
    : place_(std::move(place)),
      generator_(generator),
      policy_(policy),
      writer_(writer),
      thread_([this] { run(); }) {}

KeyframeThread::~KeyframeThread() { stop(); }

void KeyframeThread::durable(Sequence seq) {
  {
    const std::lock_guard guard(mutex_);
    durable_ = seq;
  }
  work_.notify_one();
}

void KeyframeThread::stop() {
  {
    const std::lock_guard guard(mutex_);
    stopping_ = true;
  }
  work_.notify_one();
  if (thread_.joinable()) thread_.join();
}

bool KeyframeThread::is_stopping() const {
  const std::lock_guard guard(mutex_);
  return stopping_;
}

bool KeyframeThread::wait_for(Sequence seq) {
  std::unique_lock lock(mutex_);
  work_.wait(lock, [&] { return stopping_ || durable_ >= seq; });
  return !stopping_;
}

bool KeyframeThread::rest(std::chrono::nanoseconds time) {
  std::unique_lock lock(mutex_);
  return !work_.wait_for(lock, time, [this] { return stopping_; });
}

StoreResult<void> KeyframeThread::save(KeyframeMaker::Chunks chunks,
                                       const std::optional<Keyframe>& keyframe) {
  const auto answer = std::make_shared<WriterAnswer<void>>();
  const bool is_taken =
      writer_.save_keyframe(std::move(chunks), keyframe,
                            [answer](StoreResult<void> result) { answer->set(std::move(result)); });
  if (is_taken) return answer->wait();
  return failure(
      StoreError{StoreError::Kind::cancelled, place_, "keyframe", "the log writer has ended"});
}

void KeyframeThread::run() {
  const auto failed = [](const StoreError& error) {
    if (error.kind == StoreError::Kind::cancelled) return;
    logger("store").error("no more keyframes until the next start: {}", error.message());
  };
  auto reader = open_world(place_, StoreAccess::read_only);
  if (!reader) return failed(reader.error());
  KeyframeMaker maker(**reader, generator_, policy_);
  int outruns = 0;
  for (;;) {
    const std::uint64_t before = maker.made();
    const auto made = maker.make_due(
        [this](KeyframeMaker::Chunks chunks, const std::optional<Keyframe>& keyframe) {
          return save(std::move(chunks), keyframe);
        },
        [this](Sequence, Sequence) {
          std::this_thread::yield();  // lets the threads that serve players run first
          return !is_stopping();
        });
    // Retention has moved the beginning of the log past the edits that the keyframe needed.
    const bool is_outrun = !made && made.error().kind == StoreError::Kind::bad_request;
    if (is_outrun && ++outruns <= kOutrunsMax) {
      if (!rest(kOutrunRest)) return;
      continue;
    }
    if (!made) return failed(made.error());
    outruns = 0;
    if (maker.made() > before)
      logger("store").info("keyframes made={} seq={}", maker.made() - before, maker.read_to());
    if (!wait_for(std::min(maker.read_to() + kPortionEdits, maker.look_again_at()))) return;
  }
}

}  // namespace runstone
