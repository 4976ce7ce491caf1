// worker: forest -> this: slots, bricks, light over several updates -> frames of the newest tree
#include "live/live_renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "gl/atlas.h"
#include "gl/ground_pass.h"
#include "gl/light_pass.h"
#include "gl/picture.h"
#include "gl/switches.h"
#include "gl/view_pass.h"
#include "live/fingerprint.h"
#include "live/light_batch.h"
#include "live/live_error.h"
#include "live/pixel_reuse.h"
#include "live/pixel_shares.h"
#include "live/resident_tree.h"
#include "live/seen_distance.h"
#include "live/tree_worker.h"

extern const char* const nepho_shader_view;
extern const char* const nepho_shader_ground;

namespace nepho {
namespace {

constexpr GLuint kCounterBinding = 6;
constexpr std::size_t kRefreshes = 4;

RenderRequest live(RenderRequest request) {
  request.any_tree = true;
  return request;
}

}  // namespace

class LiveRenderer::Impl {
 public:
  Impl(const RenderRequest& request, const LiveLimits& limits)
      : limits_(limits),
        budget_(share_budget(request.settings.budget_mib, gl::sky_lights(request),
                             gl::tells_ice(request))),
        sky_(gl::sky_lights(request)),
        ice_(gl::tells_ice(request)),
        slots_(budget_.slots),
        atlas_(gl::make_brick_atlas(budget_.atlas_size, ice_)),
        light_atlas_(gl::make_texture_3d(budget_.atlas_size, sky_ ? GL_RGBA16F : GL_R16F)),
        light_tiles_(limits.light_tiles),
        worker_(budget_, request.volumes.size()) {
    if (ice_) ice_atlas_ = gl::view_of_ice(atlas_);
    set(request);
  }

  void set(const RenderRequest& request);
  bool update();
  bool at_rest() const;
  bool complete() const;
  const RenderSettings& settings() const { return request_.settings; }
  HdrImage frame(int each);
  bool whole() const { return !changed_ && shares_.whole(); }
  bool streaming() const { return next_ || !stale_.empty(); }
  LiveStatus status() const;
  std::optional<ErrorEstimate> error(const HdrImage& frame);
  void reuse_pixels(bool reuse);

 private:
  // The next tree, while it is uploaded and lit.
  struct Next {
    std::unique_ptr<ResidentTree> tree;
    std::uint64_t light = 0;              // what its light is to be worked out for
    std::size_t uploaded = 0;             // leaves
    std::vector<std::size_t> unlit = {};  // leaves without any light, once all bricks are there
    bool listed = false;
    int map_parts = 0;  // of the sun map, drawn
  };

  void begin(std::unique_ptr<LiveTree> tree);
  bool upload_some();
  void light_some(ResidentTree& tree, std::uint64_t light, std::vector<std::size_t>& leaves);
  bool advance();
  HdrImage march(int each);
  FrameData whole_view() const;
  void list_stale();
  void refresh_some();
  void bind(ResidentTree& tree, const FrameData& frame);

  LiveLimits limits_;
  LiveBudget budget_;
  bool sky_, ice_;
  RenderRequest request_;
  std::vector<double> asked_;  // fingerprint of request_
  gl::Programs programs_;
  Slots slots_;
  gl::Texture atlas_, ice_atlas_, light_atlas_;
  gl::Buffer counters_;
  int light_tiles_;  // of the next batch
  std::uint64_t last_light_ = 0, last_request_ = 0;
  LiveStatus counts_;
  TreeWorker worker_;  // outlives the trees
  std::unique_ptr<ResidentTree> shown_;
  std::uint64_t shown_light_ = 0;
  std::vector<std::size_t> stale_;  // leaves of shown_, those in the picture last: taken from there
  std::size_t unseen_stale_ = 0;    // a frame is worth it when no more than these are left
  std::optional<Next> next_;
  bool changed_ = false;  // since the last frame
  PixelShares shares_;
  LiveError error_;  // ends before the worker, whose sources its tree reads
  bool reuse_ = true;
  PixelReuse pixels_;
  std::vector<double> look_;        // of what they show
  std::vector<float> distances_m_;  // of the last share
};

void LiveRenderer::Impl::set(const RenderRequest& request) {
  const std::vector<double> wanted = fingerprint(request);
  if (wanted == asked_) return;
  const bool new_contents =
      asked_.empty() || contents_fingerprint(request) != contents_fingerprint(request_);
  request_ = live(request);
  request_.settings.budget_mib = double(budget_.budget_bytes) / (1024.0 * 1024.0);
  asked_ = wanted;
  changed_ = true;
#ifndef NEPHO_MUTANT_LIVE_OLD_ERROR
  error_.drop();
#endif
  worker_.ask(request_, new_contents, ++last_request_, next_.has_value());
}

bool LiveRenderer::Impl::update() {
  if (!next_ && !error_.ending())  // no more trees at once than the budget was shared among
    if (auto tree = worker_.take()) begin(std::move(tree));
  if (next_)
    changed_ = advance() || changed_;
  else if (!stale_.empty())
    refresh_some();
  return changed_;
}

// A frame costs more than a batch of light: it is worth one after a share of what was stale.
void LiveRenderer::Impl::refresh_some() {
  light_some(*shown_, shown_light_, stale_);
  if (stale_.size() > unseen_stale_) return;
  unseen_stale_ = stale_.size() - stale_.size() / kRefreshes;
  if (stale_.size() < kRefreshes) unseen_stale_ = 0;
  changed_ = true;
}

// Two trees always have room: each is charged for half of the slots at most.
void LiveRenderer::Impl::begin(std::unique_ptr<LiveTree> tree) {
  const bool as_lit = shown_ && same_light(*tree, shown_->tree());
  auto resident = ResidentTree::make(std::move(tree), slots_, shown_.get());
  if (!resident) return;
  next_.emplace(Next{std::move(resident), as_lit ? shown_light_ : ++last_light_});
}

// One step; true where the tree has taken its place.
bool LiveRenderer::Impl::advance() {
  Next& next = *next_;
#if defined(NEPHO_MUTANT_LIVE_NO_PARENTS)
  next.uploaded = next.tree->tree().leaves.size();
  next.listed = true;
#endif
  if (upload_some()) return false;
  if (!next.listed) {
    const LiveTree& tree = next.tree->tree();
    for (std::size_t leaf = 0; leaf < tree.leaves.size(); ++leaf)
      if (slots_[next.tree->slot(leaf)].lit_for == 0) next.unlit.push_back(leaf);
    next.listed = true;
  }
  if (!next.unlit.empty()) {
    light_some(*next.tree, next.light, next.unlit);
    return false;
  }
  gl::PlanetPasses* planet = next.tree->planet();
  if (planet && next.map_parts < planet->sun_map_parts()) {
    bind(*next.tree, next.tree->tree().scene.frame);
    planet->draw_sun_map_part(programs_, next.tree->switches(false), next.map_parts++);
    glFinish();
    return false;
  }
  shown_ = std::move(next.tree);
  shown_light_ = next.light;
  next_.reset();
  ++counts_.trees;
  list_stale();
  return true;
}

void LiveRenderer::Impl::list_stale() {
  stale_.clear();
#if defined(NEPHO_MUTANT_LIVE_STALE)
  return;
#endif
  const std::vector<LiveTree::Leaf>& leaves = shown_->tree().leaves;
  for (const bool seen : {false, true})
    for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf)
      if (leaves[leaf].seen == seen && slots_[shown_->slot(leaf)].lit_for != shown_light_)
        stale_.push_back(leaf);
  unseen_stale_ = stale_.size() - stale_.size() / kRefreshes;
}

// True where some were left to do.
bool LiveRenderer::Impl::upload_some() {
  Next& next = *next_;
  const std::vector<LiveTree::Leaf>& leaves = next.tree->tree().leaves;
  std::uint64_t bytes = 0;
  for (; next.uploaded < leaves.size() && bytes < limits_.upload_bytes; ++next.uploaded) {
    const LeafBrick* brick = leaves[next.uploaded].brick;
    const std::uint32_t slot = next.tree->slot(next.uploaded);
    if (!brick || slots_[slot].has_brick) continue;
    bytes += gl::upload_tile(atlas_, budget_.atlas_size, slot, *brick, ice_);
    slots_[slot].has_brick = true;
    ++counts_.bricks_uploaded;
  }
  return bytes > 0;
}

// A batch from the end of `leaves`.
void LiveRenderer::Impl::light_some(ResidentTree& tree, std::uint64_t light,
                                    std::vector<std::size_t>& leaves) {
  const std::size_t count =
      std::min(leaves.size(), std::size_t(std::clamp(light_tiles_, 1, limits_.light_tiles)));
  std::vector<std::size_t> batch(leaves.end() - std::ptrdiff_t(count), leaves.end());
  leaves.resize(leaves.size() - count);
  std::ranges::sort(batch);
  std::vector<std::uint32_t> places;
  for (const std::size_t leaf : batch) places.push_back(tree.slot(leaf));

  const auto begin = std::chrono::steady_clock::now();
  const std::size_t programs = programs_.size();
  bind(tree, tree.tree().scene.frame);
  const gl::LightSamples samples(forest_of(tree.tree(), batch));
  gl::LightPass pass(programs_, tree.switches(false), light_atlas_, sky_, tree.phases(), places);
  pass.sun_depth(samples);
  if (sky_) pass.sky_visibility(samples);
  pass.clear_samples(samples);
  glFinish();
  gl::check_errors("light");
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  // A first batch compiles, and says nothing of the next.
  if (programs == programs_.size())
    light_tiles_ = std::clamp(int(double(count) * limits_.light_ms / std::max(took.count(), 0.1)),
                              1, limits_.light_tiles);
  for (const std::uint32_t slot : places) slots_[slot].lit_for = light;
  counts_.tiles_lit += count;
}

bool LiveRenderer::Impl::at_rest() const {
  if (worker_.busy() || next_ || !stale_.empty()) return false;
  if (worker_.failure()) return true;
  return shown_ && complete() && shown_->tree().number == last_request_;
}

// As fine as asked for, and no finer for what was seen before.
bool LiveRenderer::Impl::complete() const {
  const LiveTree& tree = shown_->tree();
  return tree.complete || worker_.rested() == tree.number;
}

// The memory of the tree that the worker would make is the probe's.
std::optional<ErrorEstimate> LiveRenderer::Impl::error(const HdrImage& frame) {
  if (!at_rest() || !whole() || !shown_ || frame.width != request_.settings.width) {
    error_.drop();
    return std::nullopt;
  }
  const bool failed = worker_.failure().has_value();  // the frame shows an earlier request
  if (!failed && request_.settings.probe_pixels > 0)
    error_.begin(request_, shown_->shared_tree(), frame,
                 double(budget_.tree_bytes) / (1024.0 * 1024.0));
  return error_.result();
}

void LiveRenderer::Impl::bind(ResidentTree& tree, const FrameData& frame) {
  tree.bind(frame);
  const gl::MarchCounters none{};
  counters_ = gl::Buffer(&none, sizeof none);
  counters_.bind(kCounterBinding);
  glBindTextureUnit(0, atlas_.id());
  glBindTextureUnit(1, light_atlas_.id());
  if (ice_) glBindTextureUnit(2, ice_atlas_.id());
}

void LiveRenderer::Impl::reuse_pixels(bool reuse) {
  if (reuse == reuse_) return;
  reuse_ = reuse;
  pixels_.clear();
  changed_ = true;
}

HdrImage LiveRenderer::Impl::frame(int each) {
  if (!shown_) return {};
  const bool changed = std::exchange(changed_, false);
  if (changed || each != shares_.each() || shares_.whole())
    shares_.begin(each, request_.settings.width, request_.settings.height, reuse_);
  shares_.add(march(each));
  if (!reuse_ || each == 1) {
    pixels_.clear();
    return shares_.picture();
  }
  std::vector<double> look = look_fingerprint(*shown_->tree().request);
  if (look != look_) pixels_.clear();
  look_ = std::move(look);
  HdrImage picture;
  gl::timed(counts_.passes, "reuse",
            [&] { picture = pixels_.picture(whole_view(), shares_, distances_m_, !changed); });
  return picture;
}

// From where the last request stands, in its size.
FrameData LiveRenderer::Impl::whole_view() const {
  FrameData frame = shown_->tree().scene.frame;
  gl::set_camera(frame, request_.camera, request_.settings);
  return frame;
}

// The next share.
HdrImage LiveRenderer::Impl::march(int each) {
  const LiveTree& tree = shown_->tree();
  RenderRequest request = *tree.request;
  request.camera = request_.camera;
  request.settings.width = request_.settings.width / each;
  request.settings.height = request_.settings.height / each;
  request.keep_depths = reuse_;
  const int width = request.settings.width, height = request.settings.height;
  FrameData frame = whole_view();
  frame.width = width;
  frame.height = height;
  shift_to_share(frame, each, shares_.offset());
  bind(*shown_, frame);
  counts_.passes.clear();
  gl::PixelValues values;
  gl::PlanetPasses* planet = shown_->planet();
  if (planet)
    gl::timed(counts_.passes, "surface", [&] {
      values.met = planet->ground_distances(programs_, shown_->switches(false), width, height);
    });
  // One program for pictures in shares and in one.
  const std::string switches = (reuse_ ? gl::kDepthSwitch : "") + shown_->switches(true);
  gl::timed(counts_.passes, "view", [&] {
    gl::march_view(request, tree.forest, programs_.get("view", nepho_shader_view, switches),
                   values);
  });
  if (reuse_ && each > 1) distances_m_ = seen_distances(values, planet != nullptr);
  if (planet)
    gl::timed(counts_.passes, "ground", [&] {
      gl::light_ground(request, tree.forest, frame, planet->scene(),
                       programs_.get("ground", nepho_shader_ground, shown_->switches(false)),
                       values);
    });
  gl::MarchCounters counters;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(counters_.id(), 0, sizeof counters, &counters);
  counts_.overruns = counters.overruns;
  return gl::picture_of(values, width, height);
}

LiveStatus LiveRenderer::Impl::status() const {
  LiveStatus status = counts_;
  status.budget_bytes = budget_.budget_bytes;
  status.gpu_bytes = budget_.gpu_bytes;
  // The probes of the error line may take what a tree may: there is none being made then.
  std::uint64_t host_bytes = worker_.tree_bytes();
  if (error_.under_way()) host_bytes += budget_.tree_bytes;
  status.trees_held = worker_.trees();
  for (const ResidentTree* tree : {shown_.get(), next_ ? next_->tree.get() : nullptr}) {
    if (!tree) continue;
    ++status.trees_held;
    host_bytes += tree->tree().host_bytes();
    status.gpu_bytes += tree->gpu_bytes();
    if (tree->tree().planet) status.planet_bytes += tree->tree().planet->gpu_bytes();
  }
  if (shown_) {
    const LiveTree& tree = shown_->tree();
    status.leaves = tree.leaves.size();
    for (const VolumeTree& volume : tree.forest.volumes) status.nodes += volume.nodes.size();
    status.complete = complete();
    status.budget_bound = tree.forest.budget_bound;
  }
  const CachedSource::Counts cache = worker_.cache_counts();
  status.cache_bytes = cache.bytes;
  status.bricks_read = cache.bricks_read;
  status.bricks_remembered = cache.bricks_remembered;
  status.bytes = status.gpu_bytes + status.cache_bytes + host_bytes;
  status.stale_tiles = stale_.size();
  status.programs = programs_.size();
  status.failure = worker_.failure();
  return status;
}

LiveRenderer::LiveRenderer(const RenderRequest& request, const LiveLimits& limits)
    : impl_(std::make_unique<Impl>(request, limits)) {}
LiveRenderer::~LiveRenderer() = default;
void LiveRenderer::set(const RenderRequest& request) {
  impl_->set(request);
}
bool LiveRenderer::update() {
  return impl_->update();
}
bool LiveRenderer::at_rest() const {
  return impl_->at_rest();
}
HdrImage LiveRenderer::frame(int each) {
  const RenderSettings& settings = impl_->settings();
  if (each < 1 || (each & (each - 1)) || settings.width % each || settings.height % each)
    throw Error({"a picture cannot be marched in such shares", "frame",
                 "a power of two that divides width and height", std::to_string(each), ""});
  return impl_->frame(each);
}
void LiveRenderer::reuse_pixels(bool reuse) {
  impl_->reuse_pixels(reuse);
}
bool LiveRenderer::streaming() const {
  return impl_->streaming();
}
bool LiveRenderer::whole() const {
  return impl_->whole();
}
std::optional<ErrorEstimate> LiveRenderer::error(const HdrImage& frame) {
  return impl_->error(frame);
}
LiveStatus LiveRenderer::status() const {
  return impl_->status();
}

}  // namespace nepho
