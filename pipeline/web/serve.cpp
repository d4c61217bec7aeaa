#include "pipeline/web/serve.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;
constexpr size_t kMostRequest_bytes = 16 * 1024;
constexpr timeval kPatience{2, 0};  // with a browser that has connected and says nothing, for all others wait

std::string TypeOf(const fs::path& file) {
  static const std::map<std::string, std::string> types{
      {".html", "text/html; charset=utf-8"}, {".js", "text/javascript"}, {".css", "text/css"},
      {".json", "application/json"},         {".jpg", "image/jpeg"},     {".png", "image/png"}};
  const auto known = types.find(file.extension().string());
  return known == types.end() ? "application/octet-stream" : known->second;
}

// The path asked for, without what follows '?'; empty where the request is none that we answer.
std::string PathOf(const std::string& request) {
  const size_t method = request.find(' '), end = request.find(' ', method + 1);
  if (method == std::string::npos || end == std::string::npos) return "";
  const std::string name = request.substr(0, method);
  if (name != "GET" && name != "HEAD") return "";
  std::string path = request.substr(method + 1, end - method - 1);
  return path.substr(0, path.find_first_of("?#"));
}

bool Send(int to, const void* bytes, size_t count) {
  for (const char* at = static_cast<const char*>(bytes); count > 0;) {
    const ssize_t sent = send(to, at, count, MSG_NOSIGNAL);
    if (sent <= 0) return false;
    at += sent;
    count -= static_cast<size_t>(sent);
  }
  return true;
}

std::string Receive(int from) {
  std::string request;
  char part[2048];
  while (request.find("\r\n\r\n") == std::string::npos && request.size() < kMostRequest_bytes) {
    const ssize_t got = recv(from, part, sizeof part, 0);
    if (got <= 0) break;
    request.append(part, static_cast<size_t>(got));
  }
  return request;
}

void Answer(int browser, const fs::path& folder) {
  setsockopt(browser, SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
  setsockopt(browser, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
  const std::string request = Receive(browser);
  std::string path = PathOf(request);
  if (path.ends_with('/')) path += "index.html";
  std::vector<uint8_t> content;
  // Nothing outside of the folder: names of the site need no '..' and no escapes.
  const bool found = path.starts_with('/') && path.find("..") == std::string::npos &&
                     path.find('%') == std::string::npos && !ReadFile(folder / path.substr(1), &content);
  if (!found) content.clear();
  const std::string head =
      std::string("HTTP/1.1 ") + (found ? "200 OK" : "404 Not Found") +
      "\r\nContent-Type: " + (found ? TypeOf(path) : "text/plain") +
      "\r\nContent-Length: " + std::to_string(content.size()) +
      "\r\nCache-Control: no-cache\r\nX-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n";
  if (Send(browser, head.data(), head.size()) && !request.starts_with("HEAD"))
    Send(browser, content.data(), content.size());
}

}  // namespace

Error ServeSite(const fs::path& folder, int port) {
  const int listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<uint16_t>(port));
  socklen_t size = sizeof address;
  auto* any = reinterpret_cast<sockaddr*>(&address);
  if (listener < 0 || bind(listener, any, size) != 0 || listen(listener, 64) != 0) {
    const std::string why = std::strerror(errno);
    if (listener >= 0) close(listener);
    return Fail("port " + std::to_string(port) + " cannot be served: " + why + "; name another with --serve PORT");
  }
  getsockname(listener, any, &size);
  std::printf("http://127.0.0.1:%d/ shows it until Ctrl+C\n", ntohs(address.sin_port));
  std::fflush(stdout);
  for (;;) {
    const int browser = accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
    if (browser < 0) continue;
    Answer(browser, folder);
    close(browser);
  }
}

}  // namespace flaneur
