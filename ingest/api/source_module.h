#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include "bricks/box_chart.h"
#include "bricks/brick_source.h"
#include "bricks/shell_chart.h"
#include "core/log.h"

namespace nepho {

// What a source module is asked for and how it is refused. Plain pointers and counts, so that no
// container crosses the C entry; BrickSource itself is C++ and is guarded by the AbiId.

inline constexpr std::uint32_t kContractVersion = 2;  // with every verb of BrickSource, too

struct AbiId {
  std::uint32_t contract_version;
  std::uint64_t
      layout_hash;  // sizes and offsets of what crosses, sanitizer and debug flags, C++ ABI
  char compiler[64];
};

struct RequestParameter {
  const char* name;
  const char* text;  // null for a number
  double number;     // SI
  const char* unit;  // as the user wrote it; "" = dimensionless
};

// Where a local frame (x east, y north, z up, m) stands in the world; identity for a free volume.
struct Placement {
  double origin_ecef_m[3] = {0, 0, 0};
  double axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // columns: east, north, up
};

// netCDF-C and HDF5 are not thread-safe: one lock per process for all modules. Non-recursive;
// taken only inside tbb::this_task_arena::isolate.
struct IoLock {
  void (*lock)(void* context);
  void (*unlock)(void* context);
  void* context;
};

struct SourceRequest {
  const char* volume_name;
  const char* const* files;
  std::size_t file_count;
  const RequestParameter* parameters;
  std::size_t parameter_count;
  Placement placement;
  IoLock io_lock;
  LogSink log_sink;
  void* log_context;
};

// Where `open` leaves its reasons: zero-terminated, cut to fit (core/error.h's parts).
struct ModuleError {
  char what[512], where[512], expected[512], found[512], hint[512];
};

struct SourceModule {
  AbiId abi;
  // Null on failure, with `error` filled. The caller owns the source and deletes it.
  BrickSource* (*open)(const SourceRequest* request, ModuleError* error);
};

// FNV-1a over what must agree before a pointer may cross: struct layouts, and the flags that change
// the standard library's.
constexpr std::uint64_t layout_hash() noexcept {
#if defined(__SANITIZE_ADDRESS__)
  constexpr std::size_t sanitizer = 1;
#elif defined(__SANITIZE_THREAD__)
  constexpr std::size_t sanitizer = 2;
#else
  constexpr std::size_t sanitizer = 0;
#endif
#ifdef NDEBUG
  constexpr std::size_t assertions = 0;
#else
  constexpr std::size_t assertions = 1;
#endif
#ifdef _GLIBCXX_DEBUG
  constexpr std::size_t debug_containers = 1;
#else
  constexpr std::size_t debug_containers = 0;
#endif
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::size_t part :
       {std::size_t(__GXX_ABI_VERSION), std::size_t(_GLIBCXX_USE_CXX11_ABI), sanitizer, assertions,
        debug_containers,
        // what the verbs hand over
        sizeof(BrickSource), sizeof(NodeKey), sizeof(Status), sizeof(BrickView),
        sizeof(ChannelView), offsetof(ChannelView, codes), offsetof(ChannelView, scale),
        offsetof(ChannelView, offset), offsetof(ChannelView, max_abs_error), sizeof(NodeSummary),
        offsetof(NodeSummary, max_extinction_per_m),
        offsetof(NodeSummary, constant_extinction_per_m),
        offsetof(NodeSummary, unresolved_variance_per_m2), offsetof(NodeSummary, error_bound_per_m),
        offsetof(NodeSummary, children), offsetof(NodeSummary, empty),
        offsetof(NodeSummary, constant), sizeof(VolumeInfo), offsetof(VolumeInfo, chart),
        offsetof(VolumeInfo, lattice), offsetof(VolumeInfo, finest), offsetof(VolumeInfo, channels),
        offsetof(VolumeInfo, time_origin_ns), offsetof(VolumeInfo, times_s),
        offsetof(VolumeInfo, bounds), offsetof(VolumeInfo, co_albedo), offsetof(VolumeInfo, phase),
        offsetof(VolumeInfo, ice_phase), offsetof(VolumeInfo, on_planet),
        offsetof(VolumeInfo, refine_by_variance), offsetof(VolumeInfo, surface), sizeof(SurfaceMap),
        offsetof(SurfaceMap, water), offsetof(VolumeInfo, source_bytes),
        offsetof(VolumeInfo, assumptions), offsetof(VolumeInfo, facts), sizeof(ChannelInfo),
        offsetof(ChannelInfo, name), offsetof(ChannelInfo, unit), offsetof(ChannelInfo, code_bits),
        offsetof(ChannelInfo, max_abs_error), sizeof(Phase), offsetof(Phase, asymmetry),
        sizeof(OwnColumn), sizeof(DataFacts), offsetof(DataFacts, variables),
        offsetof(DataFacts, optical_depth), offsetof(DataFacts, extinction_m2),
        sizeof(DataVariable), offsetof(DataVariable, low), offsetof(DataVariable, missing),
        sizeof(Lattice), sizeof(Chart), sizeof(BoxChart), sizeof(ShellChart), sizeof(RootPosition),
        sizeof(ColumnNames),
        // what a module is asked
        sizeof(SourceRequest), offsetof(SourceRequest, files), offsetof(SourceRequest, parameters),
        offsetof(SourceRequest, placement), offsetof(SourceRequest, io_lock),
        offsetof(SourceRequest, log_sink), sizeof(RequestParameter),
        offsetof(RequestParameter, number), offsetof(RequestParameter, unit), sizeof(Placement),
        offsetof(Placement, axes), sizeof(IoLock), sizeof(ModuleError), offsetof(ModuleError, hint),
        offsetof(SourceModule, open)})
    for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (part >> 8 * byte & 0xff)) * 0x100000001b3u;
  return hash;
}

// `static`, so that it is compiled into each side with that side's flags and never resolved to the
// other's.
[[maybe_unused]] static AbiId this_abi() noexcept {
  AbiId abi = {kContractVersion, layout_hash(), {}};
  constexpr char compiler[] = "gcc-compatible " __VERSION__;
  for (std::size_t at = 0; at + 1 < sizeof(abi.compiler) && compiler[at]; ++at)
    abi.compiler[at] = compiler[at];
  return abi;
}

}  // namespace nepho

// What every module exports: const nepho::SourceModule* nepho_source_module();
extern "C" {
using nepho_source_module_fn = const nepho::SourceModule*();
}
