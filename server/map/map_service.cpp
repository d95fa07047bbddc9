#include "server/map/map_service.hpp"

#include <chrono>
#include <utility>

#include "common/core/hex.hpp"
#include "common/os/steady_clock.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/map/map_builders.hpp"
#include "server/map/map_json.hpp"

namespace runstone {
namespace {

/// Raise it with each change of how tiles are drawn: browsers then load them again.
constexpr int kMapStyle = 1;

/// Ground without edits has the version 0 in every world, so the tag names the world, too. Shapes
/// change what is drawn of equal voxels, so it names the rules of a world with shapes.
std::string etag_of(const WorldId& world, const Version& version, std::uint32_t tile_rules) {
  const std::string rules = tile_rules == kTileRules ? "" : "-" + std::to_string(tile_rules);
  return "\"" + std::to_string(kMapStyle) + "-" + to_hex(ByteView(world).first(8)) + "-" +
         std::to_string(version.epoch) + "-" + std::to_string(version.seq) + rules + "\"";
}

/// Returns true if a header If-None-Match names the tag. A tag in quotes occurs in no other one.
bool is_matched(const std::string& if_none_match, const std::string& etag) {
  return if_none_match == "*" || if_none_match.find(etag) != std::string::npos;
}

TimeUs utc_now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

MapAnswer json_answer(std::string json) {
  MapAnswer out;
  out.type = "application/json";
  out.body = std::make_shared<const std::string>(std::move(json));
  return out;
}

/// Returns true for a request that draws nothing and reads some records at most.
bool is_quick(const MapRequest& request) {
  return !std::holds_alternative<TilePictureRequest>(request) &&
         !std::holds_alternative<BuildersRequest>(request);
}

constexpr TimeUs kWarnUs = 10'000'000;
constexpr const char* kNoPast = "strangers may not see the past of this world";

}  // namespace

MapAnswer map_words(unsigned status, const std::string& sentence) {
  MapAnswer out;
  out.status = status;
  out.body = std::make_shared<const std::string>(sentence + "\n");
  return out;
}

MapService::MapService(MapThreads& threads, std::string place, std::size_t cache_bytes, Warn warn)
    : threads_(threads),
      warn_(std::move(warn)),
      caches_(cache_bytes),
      world_(std::move(place), caches_) {}

MapService::~MapService() {
  is_stopping_.store(true);
  threads_.leave(*this);
  for (const auto* queue : {&quick_, &queue_}) {
    for (const Job& job : *queue) job.reply(map_words(503, "the gateway stops"));
  }
}

void MapService::ask(MapRequest request, std::string if_none_match, Reply reply) {
  std::deque<Job>& queue = is_quick(request) ? quick_ : queue_;
  std::unique_lock lock(mutex_);
  if (queue.size() >= kQueueMax) {
    lock.unlock();
    return reply(map_words(503, "the map has much to do: ask again in a moment"));
  }
  queue.push_back({request, std::move(if_none_match), std::move(reply), steady_now_us()});
  quick_count_.store(quick_.size(), std::memory_order_relaxed);
  lock.unlock();
  threads_.wake(*this);
}

MapService::Job MapService::take_next() {
  const bool takes_quick = !quick_.empty() && (queue_.empty() || quick_in_row_ < kQuickInRowMax);
  quick_in_row_ = takes_quick ? quick_in_row_ + 1 : 0;
  std::deque<Job>& queue = takes_quick ? quick_ : queue_;
  Job job = std::move(queue.front());
  queue.pop_front();
  quick_count_.store(quick_.size(), std::memory_order_relaxed);
  return job;
}

bool MapService::turn() {
  std::unique_lock lock(mutex_);
  if (queue_.empty() && quick_.empty()) return false;
  Job job = take_next();
  lock.unlock();
  const TimeUs begun_us = steady_now_us();
  turn_ends_us_ = begun_us + job.turn * kTurnUs;
  short_turn_ends_us_ = begun_us + job.turn * kShortTurnUs;
  std::optional<MapAnswer> answer;
  if (begun_us - job.asked_us <= kAnswerUsMax) answer = serve(job);
  const TimeUs now_us = steady_now_us();
  job.work_us += static_cast<std::uint64_t>(now_us - begun_us);
  if (!answer && now_us - job.asked_us > kAnswerUsMax)
    answer = map_words(503, "this part of the map takes long to draw: ask again in a moment");
  if (answer) {
    answer->work_us = job.work_us;
    job.reply(*std::move(answer));
    lock.lock();
  } else {
    ++job.turn;
    lock.lock();
    queue_.push_back(std::move(job));  // may exceed kQueueMax by this one
  }
  return !queue_.empty() || !quick_.empty();
}

bool MapService::should_continue() const {
  const bool is_waited_for = quick_count_.load(std::memory_order_relaxed) > 0;
  return !is_stopping_.load(std::memory_order_relaxed) &&
         steady_now_us() < (is_waited_for ? short_turn_ends_us_ : turn_ends_us_);
}

std::optional<MapAnswer> MapService::serve(const Job& job) {
  const auto refreshed = world_.refresh(
      steady_now_us(), utc_now_us(), [this](Sequence, Sequence) { return !is_stopping_.load(); });
  if (!refreshed) return answer_to(refreshed.error());
  report_loss();
  if (!world_.rights().may_see) return map_words(403, world_.rights().why);
  if (const auto* tile = std::get_if<TilePictureRequest>(&job.request))
    return serve(*tile, job.if_none_match);
  if (const auto* state = std::get_if<MapStateRequest>(&job.request)) return serve(*state);
  if (const auto* builders = std::get_if<BuildersRequest>(&job.request)) return serve(*builders);
  if (std::holds_alternative<RecentEditsRequest>(job.request)) return serve_recent_edits();
  if (std::holds_alternative<RightsRequest>(job.request)) return json_answer("{}");
  return serve(std::get<MapMomentRequest>(job.request));
}

Result<MapMoment*, std::optional<MapAnswer>> MapService::moment_of(
    const std::optional<Sequence>& at) {
  using Failed = Unexpected<std::optional<MapAnswer>>;
  if (!at) return &world_.present();
  if (!world_.rights().may_look_back) return Failed{map_words(403, kNoPast)};
  if (*at > world_.present().at()) return Failed{map_words(404, "there is no such edit yet")};
  // Opening reads the log once, in one piece. A stop ends it.
  const auto progress = [this](Sequence, Sequence) { return !is_stopping_.load(); };
  auto moment = world_.past(*at, progress);
  if (moment) return *moment;
  if (moment.error().kind != StoreError::Kind::bad_request)
    return Failed{answer_to(moment.error())};
  return Failed{map_words(404, "this moment is no longer in the log, or no keyframe is near it")};
}

std::optional<MapAnswer> MapService::serve(const TilePictureRequest& request,
                                           const std::string& if_none_match) {
  const auto moment = moment_of(request.at);
  if (!moment) return moment.error();
  const Version version = MapDrawer::version(**moment, request.place);
  MapAnswer out;
  out.etag = etag_of((*moment)->meta().world_id, version, world_.tile_rules());
  if (is_matched(if_none_match, out.etag)) {
    out.status = 304;
    return out;
  }
  const std::pair<MapPlace, Version> kept_as{request.place, version};
  out.type = "image/png";
  out.body = caches_.pictures.find(kept_as);
  if (out.body != nullptr) return out;
  const auto picture = world_.draw(**moment, request.place, [this] { return should_continue(); });
  if (!picture) return answer_to(picture.error());
  caches_.pictures.put(kept_as, *picture, (*picture)->size());
  out.body = *picture;
  return out;
}

std::optional<MapAnswer> MapService::serve(const MapStateRequest& request) {
  WorldReader& reader = world_.present().reader();
  const auto range = reader.log_range();
  if (!range) return answer_to(range.error());
  const auto head = reader.log_head();
  if (!head) return answer_to(head.error());
  return json_answer(map_state_json(world_, *range, *head, request.since));
}

std::optional<MapAnswer> MapService::serve(const BuildersRequest& request) {
  if (!world_.rights().may_look_back) return map_words(403, kNoPast);
  const auto moment = moment_of(request.at);
  if (!moment) return moment.error();
  const auto top = world_.top(**moment, request.x, request.z, [this] { return should_continue(); });
  if (!top) return answer_to(top.error());
  const auto edits =
      newest_edits_of_column((*moment)->reader(), request.x, request.z, (*moment)->at());
  if (!edits) return answer_to(edits.error());
  return json_answer(map_builders_json(world_, request.x, request.z, *top, *edits));
}

std::optional<MapAnswer> MapService::serve(const MapMomentRequest& request) {
  if (!world_.rights().may_look_back) return map_words(403, kNoPast);
  WorldReader& reader = world_.present().reader();
  Sequence seq = 0;
  if (const auto* time_us = std::get_if<TimeUs>(&request.of)) {
    const auto found = reader.sequence_at(*time_us);
    if (!found && found.error().kind != StoreError::Kind::bad_request)
      return answer_to(found.error());
    if (!found) return map_words(404, "this moment is no longer in the log");
    seq = *found;
  } else {
    seq = std::get<Sequence>(request.of);
  }
  const auto end = reader.edit_at(seq);
  if (!end) return answer_to(end.error());
  if (!end->has_value()) return map_words(404, "there is no such edit in the log");
  return json_answer(map_moment_json(**end));
}

std::optional<MapAnswer> MapService::serve_recent_edits() {
  if (!world_.rights().may_look_back) return map_words(403, kNoPast);
  const auto edits = newest_edits_of_world(world_.present().reader());
  if (!edits) return answer_to(edits.error());
  return json_answer(map_edits_json(world_, *edits));
}

void MapService::report_loss() {
  const std::string loss = world_.loss() ? world_.loss()->message() : "";
  if (loss == reported_loss_) return;
  reported_loss_ = loss;
  if (!loss.empty()) warn_("LOST: " + loss + ". The map shows what is left");
}

std::optional<MapAnswer> MapService::answer_to(const StoreError& error) {
  if (error.kind == StoreError::Kind::cancelled) return std::nullopt;
  const TimeUs now_us = steady_now_us();
  if (warned_us_ == 0 || now_us - warned_us_ > kWarnUs) {
    warned_us_ = now_us;
    warn_(error.message());
  }
  return map_words(503, "the world of this map cannot be read now");
}

}  // namespace runstone
