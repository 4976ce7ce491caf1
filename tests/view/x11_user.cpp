// A user of a window on an X11 display, for tests: keys, drags, files dropped by XDND as a file
// manager does it, and a look at what is shown.
//
//   x11_user TITLE key NAME            pressed and let go, by its X11 name: F12, h
//   x11_user TITLE hold NAME MS
//   x11_user TITLE drag DX DY [X Y]    pixels, with the left button held, from there or the middle
//   x11_user TITLE type TEXT           letters, digits and . - :
//   x11_user TITLE drop FILE...
//   x11_user TITLE look PICTURE.ppm
//
// Exit status 1: no such window within ten seconds, or a drop that was not taken.
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/keysym.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
constexpr long kXdndVersion = 5;

void pause_ms(int ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

class User {
 public:
  explicit User(const std::string& title) : display_(XOpenDisplay(nullptr)) {
    if (!display_) fail("no display");
    const auto end = Clock::now() + std::chrono::seconds(10);
    while (!(window_ = find(DefaultRootWindow(display_), title))) {
      if (Clock::now() > end) fail("no window " + title);
      pause_ms(50);
    }
    XGetWindowAttributes(display_, window_, &attributes_);
  }
  ~User() { XCloseDisplay(display_); }
  User(const User&) = delete;
  User& operator=(const User&) = delete;

  void key(const char* name, int held_ms) {
    send_key(KeyPress, name);
    // A key may end the program, and nobody is told that it is let go.
    XSetErrorHandler([](Display*, XErrorEvent*) { return 0; });
    pause_ms(held_ms);
    send_key(KeyRelease, name);
  }

  void drag(int dx, int dy, int x, int y) {
    XWarpPointer(display_, None, window_, 0, 0, 0, 0, x, y);
    XSync(display_, False);
    pause_ms(120);  // a panel looks where the pointer is once a frame
    send_button(ButtonPress, x, y);
    for (int n = 1; n <= 10; ++n) {
      XWarpPointer(display_, None, window_, 0, 0, 0, 0, x + dx * n / 10, y + dy * n / 10);
      XSync(display_, False);
      pause_ms(40);
    }
    pause_ms(120);
    send_button(ButtonRelease, x + dx, y + dy);
  }

  int width() const { return attributes_.width; }
  int height() const { return attributes_.height; }

  void type(const std::string& text) {
    for (const char c : text) {
      const std::string name = c == '.'   ? "period"
                               : c == '-' ? "minus"
                               : c == ':' ? "colon"
                                          : std::string(1, c);
      const bool shifted = c == ':' || (c >= 'A' && c <= 'Z');
      send_key(KeyPress, name.c_str(), shifted);
      pause_ms(60);
      send_key(KeyRelease, name.c_str(), shifted);
      pause_ms(60);
    }
  }

  // https://www.freedesktop.org/wiki/Specifications/XDND/, version 5: enter, position, drop; the
  // window asks for the list and says when it is done.
  void drop(const std::vector<std::string>& files) {
    std::string list;
    for (const std::string& file : files)
      list += "file://" + std::filesystem::absolute(file).string() + "\r\n";
    const Atom uris = atom("text/uri-list"), copy = atom("XdndActionCopy");
    own_ = XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, 0, 0);
    XSetSelectionOwner(display_, atom("XdndSelection"), own_, CurrentTime);
    send_xdnd("XdndEnter", kXdndVersion << 24, long(uris), 0, 0);
    const int x = attributes_.width / 2, y = attributes_.height / 2;
    send_xdnd("XdndPosition", 0, long(x) << 16 | y, CurrentTime, long(copy));
    bool dropped = false;
    const auto end = Clock::now() + std::chrono::seconds(20);
    while (Clock::now() < end) {
      if (XPending(display_) == 0) {
        pause_ms(5);
        continue;
      }
      XEvent event;
      XNextEvent(display_, &event);
      if (event.type == SelectionRequest) answer(event.xselectionrequest, list);
      if (event.type != ClientMessage) continue;
      const XClientMessageEvent& message = event.xclient;
      if (message.message_type == atom("XdndStatus") && !dropped) {
        if ((message.data.l[1] & 1) == 0) fail("the window takes no files");
        send_xdnd("XdndDrop", 0, CurrentTime, 0, 0);
        dropped = true;
      }
      if (message.message_type == atom("XdndFinished")) return;
    }
    fail("the window did not take the drop");
  }

  void look(const char* file) {
    XImage* image = XGetImage(display_, window_, 0, 0, unsigned(attributes_.width),
                              unsigned(attributes_.height), AllPlanes, ZPixmap);
    std::FILE* out = image ? std::fopen(file, "wb") : nullptr;
    if (!out) fail("no picture of the window");
    std::fprintf(out, "P6\n%d %d\n255\n", image->width, image->height);
    for (int y = 0; y < image->height; ++y)
      for (int x = 0; x < image->width; ++x) {
        const unsigned long pixel = XGetPixel(image, x, y);
        for (const int shift : {16, 8, 0}) std::fputc(int(pixel >> shift & 0xff), out);
      }
    std::fclose(out);
    XDestroyImage(image);
  }

 private:
  [[noreturn]] static void fail(const std::string& text) {
    std::fprintf(stderr, "x11_user: %s\n", text.c_str());
    std::exit(1);
  }
  Atom atom(const char* name) { return XInternAtom(display_, name, False); }

  Window find(Window parent, const std::string& title) {
    char* name = nullptr;
    const bool named = XFetchName(display_, parent, &name) && title == name;
    if (name) XFree(name);
    if (named) return parent;
    Window root = 0, above = 0, *children = nullptr, found = 0;
    unsigned count = 0;
    if (!XQueryTree(display_, parent, &root, &above, &children, &count)) return 0;
    for (unsigned n = 0; n < count && !found; ++n) found = find(children[n], title);
    if (children) XFree(children);
    return found;
  }

  // Of the server's clock: GLFW takes a time for a key once only.
  static Time now() {
    return Time(
        std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now().time_since_epoch())
            .count());
  }

  template <class Event>
  void begin(Event& event, int type) {
    event.type = type;
    event.display = display_;
    event.window = window_;
    event.root = DefaultRootWindow(display_);
    event.time = now();
    event.same_screen = True;
  }

  void send_key(int type, const char* name, bool shifted = false) {
    const KeySym symbol = XStringToKeysym(name);
    if (symbol == NoSymbol) fail(std::string("no key ") + name);
    XEvent event{};
    begin(event.xkey, type);
    event.xkey.state = shifted ? ShiftMask : 0;
    event.xkey.keycode = XKeysymToKeycode(display_, symbol);
    XSendEvent(display_, window_, True, KeyPressMask | KeyReleaseMask, &event);
    XSync(display_, False);
  }

  void send_button(int type, int x, int y) {
    XEvent event{};
    begin(event.xbutton, type);
    event.xbutton.x = x;
    event.xbutton.y = y;
    event.xbutton.button = Button1;
    XSendEvent(display_, window_, True, ButtonPressMask | ButtonReleaseMask, &event);
    XSync(display_, False);
    pause_ms(60);
  }

  void send_xdnd(const char* type, long a, long b, long c, long d) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.display = display_;
    event.xclient.window = window_;
    event.xclient.message_type = atom(type);
    event.xclient.format = 32;
    const long data[5] = {long(own_), a, b, c, d};
    std::memcpy(event.xclient.data.l, data, sizeof data);
    XSendEvent(display_, window_, False, NoEventMask, &event);
    XFlush(display_);
  }

  void answer(const XSelectionRequestEvent& request, const std::string& list) {
    XChangeProperty(display_, request.requestor, request.property, request.target, 8,
                    PropModeReplace, reinterpret_cast<const unsigned char*>(list.data()),
                    int(list.size()));
    XEvent event{};
    event.xselection.type = SelectionNotify;
    event.xselection.display = display_;
    event.xselection.requestor = request.requestor;
    event.xselection.selection = request.selection;
    event.xselection.target = request.target;
    event.xselection.property = request.property;
    event.xselection.time = request.time;
    XSendEvent(display_, request.requestor, False, NoEventMask, &event);
    XFlush(display_);
  }

  Display* display_;
  Window window_ = 0, own_ = 0;
  XWindowAttributes attributes_{};
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "x11_user TITLE key|hold|drag|drop|look ...\n");
    return 2;
  }
  User user(argv[1]);
  const std::string what = argv[2];
  if (what == "key") user.key(argv[3], 80);
  if (what == "hold" && argc > 4) user.key(argv[3], std::atoi(argv[4]));
  if (what == "drag" && argc > 4)
    user.drag(std::atoi(argv[3]), std::atoi(argv[4]),
              argc > 6 ? std::atoi(argv[5]) : user.width() / 2,
              argc > 6 ? std::atoi(argv[6]) : user.height() / 2);
  if (what == "type") user.type(argv[3]);
  if (what == "drop") user.drop({argv + 3, argv + argc});
  if (what == "look") user.look(argv[3]);
  return 0;
}
