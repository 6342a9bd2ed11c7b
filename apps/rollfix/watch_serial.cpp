// A serial device: 8 data bits, no parity, one stop bit, nothing translated.
#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>

#include "rollfix/error.hpp"
#include "rollfix/watch_reconnect.hpp"

namespace rollfix::app {
namespace {

using boost::asio::serial_port_base;

class SerialSource : public ReconnectingSource {
 public:
  SerialSource(const std::string& path, const SourceOptions& options, const StopSignal& stop)
      : ReconnectingSource(path, options.once, stop), baud_(options.baud) {
    const std::string failure = connect();
    if (!failure.empty()) throw InputError(fmt::format("{}: {}", path, failure));
    set_connected();
  }

 protected:
  std::string connect() override {
    boost::system::error_code error;
    port_.open(name(), error);  // raw mode, and never the controlling terminal
    if (error) return "can't be opened: " + error.message();
    port_.set_option(serial_port_base::baud_rate(baud_), error);
    if (error) {
      disconnect();
      return fmt::format("--baud {}: {}", baud_, error.message());
    }
    port_.set_option(serial_port_base::flow_control(serial_port_base::flow_control::none), error);
    port_.set_option(serial_port_base::stop_bits(serial_port_base::stop_bits::one), error);
    return "";
  }

  void disconnect() override {
    boost::system::error_code ignored;
    port_.close(ignored);
  }

  int descriptor() override { return port_.native_handle(); }

 private:
  unsigned baud_;
  boost::asio::io_context io_;
  boost::asio::serial_port port_{io_};
};

}  // namespace

std::unique_ptr<ByteSource> open_serial(const std::string& path, const SourceOptions& options, const StopSignal& stop) {
  return std::make_unique<SerialSource>(path, options, stop);
}

}  // namespace rollfix::app
