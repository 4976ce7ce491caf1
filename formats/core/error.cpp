#include "core/error.h"

namespace nepho {
namespace {

// One line: "where: what: found X, expected Y; hint".
std::string join(const Error::Parts& p) {
  std::string text = p.where.empty() ? p.what : p.where + ": " + p.what;
  if (!p.found.empty()) text += ": found " + p.found;
  if (!p.expected.empty()) text += (p.found.empty() ? ": expected " : ", expected ") + p.expected;
  if (!p.hint.empty()) text += "; " + p.hint;
  return text;
}

}  // namespace

Error::Error(Parts parts) : std::runtime_error(join(parts)), parts_(std::move(parts)) {}

}  // namespace nepho
