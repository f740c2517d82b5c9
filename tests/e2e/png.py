"""Reads the PNG files that pirsim writes: 8-bit RGB without interlacing."""
import struct
import zlib


class Picture:
    def __init__(self, path):
        data = path.read_bytes()
        self.width, self.height, depth, kind = struct.unpack(">IIBB", data[16:26])
        assert (depth, kind) == (8, 2), (depth, kind)
        packed, at = b"", 8
        while at < len(data):
            size = struct.unpack(">I", data[at:at + 4])[0]
            if data[at + 4:at + 8] == b"IDAT":
                packed += data[at + 8:at + 8 + size]
            at += 12 + size
        self.rows = self._unfiltered(zlib.decompress(packed))

    def _unfiltered(self, raw):
        """As the PNG specification's section 9 has it."""
        size, rows, above = 3 * self.width, [], bytes(3 * self.width)
        for y in range(self.height):
            kind, line = raw[y * (size + 1)], bytearray(raw[y * (size + 1) + 1:(y + 1) * (size + 1)])
            for i in range(size):
                a, b, c = line[i - 3] if i > 2 else 0, above[i], above[i - 3] if i > 2 else 0
                if kind == 1:
                    line[i] = (line[i] + a) & 255
                elif kind == 2:
                    line[i] = (line[i] + b) & 255
                elif kind == 3:
                    line[i] = (line[i] + (a + b) // 2) & 255
                elif kind == 4:
                    p = a + b - c
                    nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
                    line[i] = (line[i] + nearest) & 255
            rows.append(bytes(line))
            above = rows[-1]
        return rows

    def at(self, x, y):
        return tuple(self.rows[y][3 * x:3 * x + 3])

    def places(self, is_wanted):
        """(x, y) of the pixels whose colour is wanted."""
        return [(x, y) for y in range(self.height) for x in range(self.width) if is_wanted(self.at(x, y))]

    def differs(self, other):
        """(x, y) of the pixels that differ between two pictures of one size."""
        return [(x, y) for y in range(self.height) if self.rows[y] != other.rows[y] for x in range(self.width)
                if self.at(x, y) != other.at(x, y)]


def box(places):
    """Left, top, right and bottom pixel."""
    xs, ys = [x for x, _ in places], [y for _, y in places]
    return min(xs), min(ys), max(xs), max(ys)
