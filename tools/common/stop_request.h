#pragma once

namespace nepho {

// While it lives, the first Ctrl-C is a request to stop soon and keep what is done; a second one
// ends the program as before.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;
  bool made() const;

 private:
  void (*before_)(int);
};

}  // namespace nepho
