#pragma once
// Archives for tests.
#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filtering_streambuf.hpp>
#include <zlib.h>

#include <sstream>
#include <string>

namespace palpate {

inline std::string gzip(const std::string& text) {
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    std::string packed(deflateBound(&stream, text.size()) + 32, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = uInt(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

inline std::string bzip2(const std::string& text) {
    std::istringstream in(text);
    std::ostringstream out;
    boost::iostreams::filtering_istreambuf filter;
    filter.push(boost::iostreams::bzip2_compressor());
    filter.push(in);
    boost::iostreams::copy(filter, out);
    return out.str();
}

}  // namespace palpate
