// A client of a server that sends a log over TCP.
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <optional>

#include "rollfix/error.hpp"
#include "rollfix/typed_number.hpp"
#include "rollfix/watch_reconnect.hpp"

namespace rollfix::app {
namespace {

using boost::asio::ip::tcp;

constexpr std::chrono::seconds kConnectTimeout{3};        // a host that says nothing at all is tried again
constexpr std::chrono::milliseconds kLookForSignals{50};  // while connecting

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

/// A socket with what it runs on. Handlers that are still waiting are dropped with it.
struct Connection {
  boost::asio::io_context io;
  tcp::resolver resolver{io};
  tcp::socket socket{io};
};

class TcpSource : public ReconnectingSource {
 public:
  TcpSource(const std::string& address, bool once, const StopSignal& stop)
      : ReconnectingSource("tcp:" + address, once, stop), address_(read_address(address)) {}

 protected:
  std::string connect() override {
    connection_.emplace();
    std::optional<boost::system::error_code> done;
    Connection& connection = *connection_;
    connection.resolver.async_resolve(
        address_.host, address_.port,
        [&](const boost::system::error_code& error, const tcp::resolver::results_type& found) {
          if (error) {
            done = error;
            return;
          }
          boost::asio::async_connect(
              connection.socket, found,
              [&done](const boost::system::error_code& result, const tcp::endpoint& /*to*/) { done = result; });
        });
    const Deadline give_up = Clock::now() + kConnectTimeout;
    while (!done && !stop().came() && Clock::now() < give_up) connection.io.run_for(kLookForSignals);
    std::string failure = !done ? "no answer" : *done ? "can't connect: " + done->message() : "";
    if (!failure.empty()) {
      connection_.reset();
      return failure;
    }
    boost::system::error_code ignored;
    connection.socket.set_option(boost::asio::socket_base::keep_alive(true), ignored);
    connection.socket.native_non_blocking(true, ignored);
    return "";
  }

  void disconnect() override { connection_.reset(); }

  int descriptor() override { return connection_->socket.native_handle(); }

 private:
  TcpAddress address_;
  std::optional<Connection> connection_;
};

}  // namespace

std::unique_ptr<ByteSource> connect_tcp(const std::string& address, bool once, const StopSignal& stop) {
  return std::make_unique<TcpSource>(address, once, stop);
}

}  // namespace rollfix::app
