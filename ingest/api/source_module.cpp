#include "api/source_module.h"

namespace nepho {

AbiId this_abi() noexcept {
  return {kContractVersion, 0, __VERSION__};
}

}  // namespace nepho
