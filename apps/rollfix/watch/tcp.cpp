// A client of a server that sends a log over TCP.
#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <thread>

#include "rollfix/arguments/typed_number.hpp"
#include "rollfix/error.hpp"
#include "rollfix/watch/source.hpp"

namespace rollfix::app {
namespace {

using asio::ip::tcp;

constexpr std::chrono::seconds kConnectTimeout{3};  // a host that says nothing at all is tried again

struct TcpAddress {
  std::string host = "127.0.0.1";
  std::string port;
};

/// "PORT", "HOST:PORT", "[IPV6]:PORT".
TcpAddress read_address(const std::string& text) {
  TcpAddress address;
  const std::size_t mark = text.rfind(':');
  address.port = text.substr(mark == std::string::npos ? 0 : mark + 1);
  if (mark != std::string::npos && mark > 0) address.host = text.substr(0, mark);
  std::string& host = address.host;
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  constexpr std::size_t kLastPort = 65535;
  const std::string what = fmt::format("--log tcp:{}: the port", text);
  if (read_count(address.port, what, 1) > kLastPort) {
    throw InputError(
        fmt::format("{} is {}, expected 1 to {}, as in tcp:localhost:7000", what, address.port, kLastPort));
  }
  return address;
}

class TcpSource final : public ReconnectingSource<tcp::socket> {
 public:
  TcpSource(const std::shared_ptr<asio::io_context>& io, const std::string& address, const SourceOptions& options,
            Hear hear)
      : ReconnectingSource(*io, "tcp:" + address, options, std::move(hear)), io_(io), address_(read_address(address)) {
    look_up();
  }

 private:
  void connect() override { look_up(); }

  /// Looks the name up in a thread that nobody waits for: that can take a minute and can't be broken off, and what
  /// async_resolve() has begun would be waited for when its io_context goes.
  void look_up() {
    std::thread([this, io = io_, address = address_] {
      error_code error;
      asio::io_context own;
      const auto found = tcp::resolver(own).resolve(address.host, address.port, error);
      asio::post(*io, [this, error, found] { looked_up(error, found); });  // not run where the source is gone
    }).detach();
  }

  void looked_up(const error_code& error, const tcp::resolver::results_type& found) {
    if (error && !was_known_) {
      throw InputError(fmt::format("{}: the host '{}' can't be found: {}", name_, address_.host, error.message()));
    }
    if (error) return failed("can't connect: " + error.message());
    was_known_ = true;
    timer_.expires_after(kConnectTimeout);
    timer_.async_wait([this](const error_code& /*error*/) {
      if (timer_.expiry() <= asio::steady_timer::clock_type::now()) stream_.close();
    });
    asio::async_connect(stream_, found, [this](const error_code& result, const tcp::endpoint& /*to*/) {
      timer_.expires_at(asio::steady_timer::time_point::max());
      if (result == asio::error::operation_aborted) return failed("no answer");
      if (result) return failed("can't connect: " + result.message());
      error_code ignored;
      stream_.set_option(asio::socket_base::keep_alive(true), ignored);
      connected();
    });
  }

  std::shared_ptr<asio::io_context> io_;
  TcpAddress address_;
  bool was_known_ = false;
};

}  // namespace

std::unique_ptr<Source> connect_tcp(const std::shared_ptr<asio::io_context>& io, const std::string& address,
                                    const SourceOptions& options, Hear hear) {
  return std::make_unique<TcpSource>(io, address, options, std::move(hear));
}

}  // namespace rollfix::app
