// What tev gets, read as its protocol says.
#include "live/tev_viewer.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace etendue::test {

namespace {

/// Listens as tev does.
class FakeTev {
  public:
    FakeTev() {
        sockaddr_in own{};
        own.sin_family = AF_INET;
        own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own), 0);
        EXPECT_EQ(::listen(socket_, 1), 0);
    }
    ~FakeTev() { ::close(socket_); }
    FakeTev(const FakeTev&) = delete;
    FakeTev& operator=(const FakeTev&) = delete;

    [[nodiscard]] TevAddress address() const {
        sockaddr_in own{};
        socklen_t size = sizeof own;
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
        return {"127.0.0.1", std::to_string(ntohs(own.sin_port))};
    }
    /// Returns all that comes over the first connection until it ends.
    [[nodiscard]] std::string receive() const {
        const int connection = ::accept(socket_, nullptr, nullptr);
        std::string all;
        std::array<char, 4096> buffer;
        for (ssize_t got = 0; (got = ::recv(connection, buffer.data(), buffer.size(), 0)) > 0;)
            all.append(buffer.data(), static_cast<std::size_t>(got));
        ::close(connection);
        return all;
    }

  private:
    int socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
};

/// Reads the fields of packets.
class Reader {
  public:
    explicit Reader(std::string bytes) : bytes_(std::move(bytes)) {}

    template <typename Number>
    Number number() {
        Number value{};
        if (at_ + sizeof value > bytes_.size()) throw std::out_of_range("the packet ends early");
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    std::string text() {
        std::string text(bytes_.c_str() + at_);
        at_ += text.size() + 1;
        return text;
    }
    std::vector<std::string> texts(std::int32_t count) {
        std::vector<std::string> all(static_cast<std::size_t>(count));
        for (std::string& each : all) each = text();
        return all;
    }
    template <typename Number>
    std::vector<Number> numbers(std::size_t count) {
        std::vector<Number> all(count);
        for (Number& each : all) each = number<Number>();
        return all;
    }
    [[nodiscard]] std::size_t at() const { return at_; }
    [[nodiscard]] bool is_at_end() const { return at_ == bytes_.size(); }

  private:
    std::string bytes_;
    std::size_t at_ = 0;
};

TEST(TevViewer, SendsTheImageAndItsLayers) {
    const FakeTev tev;
    ImageDescription image;
    image.frame.pixels = ImageF(3, 2, 4);
    for (std::size_t i = 0; i < image.frame.pixels.pixels.size(); ++i)
        image.frame.pixels.pixels[i] = static_cast<float>(i) * 0.5f;
    OutputLayer depth{.name = "depth", .channels = "Z", .pixels = ImageF(3, 2, 1)};
    depth.pixels.pixels = {1, 2, 3, 4, 5, 6};
    image.frame.layers.push_back(depth);
    {
        TevViewer viewer(tev.address());
        viewer.begin("a", "some/where/a.exr");
        EXPECT_TRUE(viewer.wants_image());
        viewer.show(image);
        EXPECT_FALSE(viewer.wants_image());
    }
    Reader packets(tev.receive());
    const auto begin_packet = [&](char kind) {
        const auto size = packets.number<std::uint32_t>();
        EXPECT_EQ(packets.number<char>(), kind);
        return packets.at() - 5 + size;
    };
    std::size_t end = begin_packet(2);  // CloseImage
    EXPECT_EQ(packets.text(), "a.exr");
    EXPECT_EQ(packets.at(), end);
    end = begin_packet(4);  // CreateImage
    EXPECT_EQ(packets.number<char>(), 1);
    EXPECT_EQ(packets.text(), "a.exr");
    EXPECT_EQ(packets.numbers<std::int32_t>(3), (std::vector<std::int32_t>{3, 2, 5}));
    EXPECT_EQ(packets.texts(5), (std::vector<std::string>{"R", "G", "B", "A", "depth.Z"}));
    EXPECT_EQ(packets.at(), end);
    for (const bool is_depth : {false, true}) {
        end = begin_packet(6);  // UpdateImageV3
        EXPECT_EQ(packets.number<char>(), 0);
        EXPECT_EQ(packets.text(), "a.exr");
        const auto count = packets.number<std::int32_t>();
        ASSERT_EQ(count, is_depth ? 1 : 4);
        EXPECT_EQ(packets.texts(count).front(), is_depth ? "depth.Z" : "R");
        EXPECT_EQ(packets.numbers<std::int32_t>(4), (std::vector<std::int32_t>{0, 0, 3, 2}));
        const auto channels = static_cast<std::size_t>(count);
        EXPECT_EQ(packets.numbers<std::int64_t>(channels).back(), count - 1) << "where the last channel begins";
        EXPECT_EQ(packets.numbers<std::int64_t>(channels).back(), count) << "from pixel to pixel";
        EXPECT_EQ(packets.numbers<float>(6 * channels), is_depth ? depth.pixels.pixels : image.frame.pixels.pixels);
        EXPECT_EQ(packets.at(), end);
    }
    EXPECT_TRUE(packets.is_at_end());
}

TEST(TevViewer, SendsEachImageUnderItsOwnName) {
    const FakeTev tev;
    {
        TevViewer viewer(tev.address());
        for (const int width : {1, 2, 3}) {
            ImageDescription image;
            image.frame.pixels = ImageF(width, 1, 4);
            viewer.begin("a", std::to_string(width) + ".exr");
            viewer.show(image);
        }
    }
    const std::string sent = tev.receive();
    for (const char width : {'\1', '\2', '\3'}) {
        // CreateImage: it takes the focus, its name, and its width, which is one byte of four.
        const std::string create =
            std::string({4, 1}) + std::to_string(width) + ".exr" + std::string({0, width, 0, 0, 0});
        EXPECT_NE(sent.find(create), std::string::npos) << int{width};
    }
}

TEST(TevViewer, MakesAnImageOnceThoughOthersComeBetween) {
    const FakeTev tev;
    OutputFrame frame;
    frame.pixels = ImageF(1, 1, 4);
    {
        TevViewer viewer(tev.address());
        for (const char* name : {"left", "right", "left", "right"}) {
            viewer.show(name, frame);
            ::usleep(20'000);  // long enough for it to be sent
        }
    }
    const std::string sent = tev.receive();
    for (const char* name : {"left", "right"}) {
        const std::string create = std::string({4, 1}) + name + std::string({0, 1, 0, 0, 0});
        ASSERT_NE(sent.find(create), std::string::npos) << name;
        EXPECT_EQ(sent.find(create), sent.rfind(create)) << name;
    }
}

TEST(TevViewer, WarnsOnceAndWantsNothingMoreIfTevIsNotThere) {
    TevAddress nowhere;
    {
        const FakeTev gone;
        nowhere = gone.address();
    }
    testing::internal::CaptureStderr();
    {
        TevViewer viewer(nowhere);
        viewer.begin("a", "a.exr");
        ImageDescription image;
        image.frame.pixels = ImageF(1, 1, 4);
        viewer.show(image);
        ::usleep(700'000);  // longer than it leaves between images
        EXPECT_FALSE(viewer.wants_image());
        viewer.show(image);
    }
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("--tev 127.0.0.1:"), std::string::npos) << said;
    EXPECT_EQ(said.find("--tev"), said.rfind("--tev")) << said;
}

TEST(TevAddress, IsAHostAndAPort) {
    EXPECT_EQ(TevAddress::parse("localhost:14158")->port, "14158");
    EXPECT_EQ(TevAddress::parse("::1:14158")->host, "::1");
    for (const char* const text : {"", "localhost", ":14158", "localhost:", "localhost:tev"})
        EXPECT_FALSE(TevAddress::parse(text)) << text;
}

}  // namespace

}  // namespace etendue::test
