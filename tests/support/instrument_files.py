"""One grooved surface, written as instruments write it, after the formats' descriptions."""

import struct
import warnings

import numpy as np

PERIOD = 1e-5
SIN = (0.02, 0.004)  # steep climbs, gentle falls: a mirrored file would show
COUNT, ROWS, PIXEL = 320, 3, 2.5e-7
X = PIXEL * np.arange(COUNT)


def heights(rows=ROWS):
    """In m, shape (rows, COUNT): grooves that cross the rows at an angle."""
    phase = 2 * np.pi * (X / PERIOD + 0.1 * np.arange(rows)[:, None])
    return PERIOD * (SIN[0] * np.sin(phase) + SIN[1] * np.sin(2 * phase))


def sdf_text(path, z):
    """ISO 25178-71, as text: a header `key = value`, numbers, parted by `*`."""
    values = "\n".join(str(round(v * 1e13)) for v in z.ravel())
    header = {
        "ManufacID": "any",
        "CreateDate": "010120260000",
        "ModDate": "010120260000",
        "NumPoints": COUNT,
        "NumProfiles": len(z),
        "Xscale": PIXEL,
        "Yscale": PIXEL,
        "Zscale": 1e-13,
        "Zresolution": -1,
        "Compression": 0,
        "DataType": 6,
        "CheckType": 0,
    }
    lines = "\n".join(f"{key} = {value}" for key, value in header.items())
    path.write_text(f"aISO-1.0\n{lines}\n*\n{values}\n*\n")


def sdf(path, z):
    """ISO 25178-71, binary: lengths in m."""
    head = struct.pack("<8s10s12s12s", b"bISO-1.0", b"any", b"010120260000", b"")
    sizes = struct.pack("<HHddddBBB", COUNT, len(z), PIXEL, PIXEL, 1.0, -1.0, 0, 7, 0)
    path.write_bytes(head + sizes + z.astype("<f8").tobytes())


def sur(path, z, missing=None):
    """Digital Surf: 512 bytes, then whole numbers; x in mm, z in um."""
    counts = np.round(z / 1e-13).astype("<i4")
    low, high = int(counts.min()), int(counts.max())
    if missing is not None:
        counts[missing] = low - 2
    names = [b"X", b"Y", b"Z", b"mm", b"mm", b"um", b"mm", b"mm", b"um"]
    parts = [
        struct.pack("<12sHHHH30s30s", b"DIGITAL SURF", 0, 1, 1, 2, b"", b""),
        struct.pack("<HHHHHIIH", 0, 0, 0, int(missing is not None), 1, 0, 0, 32),
        struct.pack("<iiiiI", low, high, COUNT, len(z), z.size),
        struct.pack("<fff", 1e3 * PIXEL, 1e3 * PIXEL, 1e-7),
        *(struct.pack("<16s", name) for name in names),
        struct.pack("<fffHHHIII", 1, 1, 1, 0, 0, 0, 0, 0, 0),
        struct.pack("<7HfIIHHH", 0, 0, 0, 1, 1, 2026, 0, 0, 0, 0, 0, 0, 0),
        struct.pack("<128sfff34s", b"", 0, 0, 0, b""),
    ]
    header = b"".join(parts)
    assert len(header) == 512
    path.write_bytes(header + counts.tobytes())


def bcr(path, z):
    """BCR-STM: a text of 2048 bytes, then heights in 16 bits."""
    bit = 1e9 * np.max(np.abs(z)) / 3e4
    lines = {
        "fileformat": "bcrstm",
        "headersize": 2048,
        "xpixels": COUNT,
        "ypixels": len(z),
        "xlength": 1e9 * PIXEL * COUNT,
        "ylength": 1e9 * PIXEL * len(z),
        "intelmode": 1,
        "bit2nm": bit,
        "xunit": "nm",
        "yunit": "nm",
        "zunit": "nm",
    }
    text = "".join(f"{key} = {value}\n" for key, value in lines.items())
    counts = np.round(1e9 * z / bit).astype("<i2")
    path.write_bytes(text.encode().ljust(2048) + counts.tobytes())


def tmd(path, z):
    """TrueMap 2: lengths in mm."""
    head = b"Binary TrueMap Data File v2.0\r\n\0" + b"Created by TrueMap v6\r\n\0"
    size = 1e3 * PIXEL * COUNT, 1e3 * PIXEL * len(z)
    numbers = struct.pack("<IIffff", COUNT, len(z), *size, 0, 0)
    path.write_bytes(head + numbers + (1e3 * z).astype("<f4").tobytes())


def os3d(path, z):
    """OmniSurf3D: lengths in um."""
    texts = b"".join(struct.pack("<i", len(t)) + t for t in (b"grooves", b"2026"))
    numbers = struct.pack("<iidddd", COUNT, len(z), 1e6 * PIXEL, 1e6 * PIXEL, 0, 0)
    start = b"OmniSurf3D" + struct.pack("<ii", 1, 0)
    path.write_bytes(start + texts + numbers + (1e6 * z).astype("<f4").tobytes())


def gwy(path, z):
    """Gwyddion: named components in containers; two channels, the phase first."""

    def part(name, kind, data):
        return name.encode() + b"\0" + kind + data

    def container(name, *parts):
        body = b"".join(parts)
        return name.encode() + b"\0" + struct.pack("<I", len(body)) + body

    def field(values, unit):
        units = (
            part(f"si_unit_{axis}", b"o", container("GwySIUnit", part("unitstr", b"s", u)))
            for axis, u in (("xy", b"m\0"), ("z", unit))
        )
        size = struct.pack("<I", values.size)
        return container(
            "GwyDataField",
            part("xres", b"i", struct.pack("<i", COUNT)),
            part("yres", b"i", struct.pack("<i", len(values))),
            part("xreal", b"d", struct.pack("<d", PIXEL * COUNT)),
            part("yreal", b"d", struct.pack("<d", PIXEL * len(values))),
            *units,
            part("data", b"D", size + values.astype("<f8").tobytes()),
        )

    whole = container(
        "GwyContainer",
        part("/0/data", b"o", field(0 * z + 1, b"deg\0")),
        part("/1/data", b"o", field(z, b"m\0")),
        part("/1/data/title", b"s", b"Topography\0"),
        part("/2/data", b"o", field(2 * z, b"m\0")),
        part("/2/data/title", b"s", b"Backwards\0"),
    )
    path.write_bytes(b"GWYP" + whole)


def _through_surface_topography(method):
    def write(path, z):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            from SurfaceTopography import Topography

            sizes = 1e6 * PIXEL * COUNT, 1e6 * PIXEL * len(z)
            surface = Topography(np.ascontiguousarray(1e6 * z.T), sizes, unit="\u00b5m")
            getattr(surface, method)(str(path))

    return write


FORMATS = {
    "sdf": sdf,
    "text.sdf": sdf_text,
    "sur": sur,
    "bcr": bcr,
    "tmd": tmd,
    "os3d": os3d,
    "gwy": gwy,
    "nc": _through_surface_topography("to_netcdf"),
    "x3p": _through_surface_topography("to_x3p"),
}
