// Modules that must be refused, or that fail in ways a module may.
#include <stdexcept>

#include "api/module_support.h"

namespace {

nepho::AbiId abi() {
  nepho::AbiId id = nepho::this_abi();
#ifdef FAKE_OTHER_CONTRACT
  id.contract_version += 41;
#endif
#ifdef FAKE_OTHER_LAYOUT
  id.layout_hash ^= 1;
#endif
  return id;
}

std::unique_ptr<nepho::BrickSource> open(const nepho::SourceRequest& request) {
  nepho::Parameters parameters(request);
  const std::string what =
      parameters.choice("throw", {"error", "bad_alloc", "int", "lock", "long"});
  parameters.number_in("fraction", 0.5, 0, 1);
  parameters.finish();
  if (what == "bad_alloc") throw std::bad_alloc();
  if (what == "int") throw 7;
  if (what == "long") throw std::runtime_error(std::string(5000, 'x'));
  if (what == "lock") {
    const nepho::IoGuard guard(request.io_lock);
    request.log_sink(request.log_context, nepho::LogLevel::kWarning, "locked");
  }
  throw nepho::Error({"what", "where", "expected", "found", "hint"});
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const nepho::SourceModule* nepho_source_module() {
  static const nepho::SourceModule module = {
      abi(), [](const nepho::SourceRequest* request, nepho::ModuleError* error) {
        return nepho::open_guarded(error, [&] { return open(*request); });
      }};
  return &module;
}
