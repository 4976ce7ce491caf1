#pragma once

#include <cstddef>
#include <cstdint>

#include "bricks/brick_source.h"
#include "core/log.h"

namespace nepho {

// What a source module is asked for and how it is refused. Plain pointers and counts, so that no
// container crosses the C entry; BrickSource itself is C++ and is guarded by the AbiId.

inline constexpr std::uint32_t kContractVersion = 1;

struct AbiId {
  std::uint32_t contract_version;
  std::uint64_t
      layout_hash;  // sizes and offsets of what crosses, sanitizer and debug flags, C++ ABI
  char compiler[64];
};

// Evaluated where it is compiled in: the host's and the module's can differ.
AbiId this_abi() noexcept;

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

}  // namespace nepho

// What every module exports: const nepho::SourceModule* nepho_source_module();
extern "C" {
using nepho_source_module_fn = const nepho::SourceModule*();
}
