// Boost.Asio as the web server uses it: one thread, coroutines, errors as values.
//
// g++ 12 destroys temporaries of class type among the arguments of a co_await twice: give them names first.
#pragma once

#include <utility>  // before awaitable.hpp: Boost 1.81 forgets it under g++ 12
//
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/this_coro.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>

namespace server {

namespace net = boost::asio;
using tcp = net::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

// co_await x.async_y(..., quietly(error)): the error comes back in `error` instead of as an exception.
inline auto quietly(error_code& error) { return net::redirect_error(net::use_awaitable, error); }

}  // namespace server
