"""Small record files in every format, as their networks write them: text by name, with what they hold."""

import numpy as np

from stylobate.constants import g

COUNT, DT = 23, 0.01
WAVES = [
    np.round(np.sin(np.arange(COUNT) * 0.9 + phase) * size, 3) for phase, size in ((0.0, 1.5), (1.0, -1.2), (2.0, 0.7))
]


def rows(values, per_line, form, glue=""):
    texts = [form % value for value in values]
    return "\n".join(glue.join(texts[i : i + per_line]) for i in range(0, len(texts), per_line)) + "\n"


def peak_of(wave):
    """The value of largest size, and its time [s]."""
    at = int(np.abs(wave).argmax())
    return wave[at], at * DT


def integers(places, lines, per_line, width):
    values = [places.get(i, 0) for i in range(100 if per_line > 8 else lines * per_line)]
    return rows(values, per_line, f"%{width}d")


# -- one small file per format: name → (text, unit of the numbers in m/s², azimuths, axes) ---------------------------


def csmip_v2(end="\n"):
    text = ""
    for i, label in enumerate(("90 Deg", "Up", "360 Deg")):
        count = COUNT - (i == 2)
        head = [
            "Corrected accelerogram   12345-A1",
            "Uncorrected Accelerogram Data   Processed: today",
            "SMALL EARTHQUAKE",
        ]
        head += [
            "May 2, 1983",
            "12345-A1   Start time: 05/02/83, 23:42:48 UTC",
            "Station No. 12345  35.9N, 120.5W",
            "A PLACE",
        ]
        peak, time = peak_of(WAVES[i][:count])
        head += [
            f"Chan  {i + 1}: {label}",
            *(["line"] * 3),
            f"                        Record length = {count * DT:.3f} sec.",
        ]
        head += [
            *(["line"] * 4),
            "At equally-spaced intervals of    .010  sec.",
            f"Peak acceleration = {peak:9.3f}    cm/sec/sec  at   {time:.3f}   sec.",
            *(["line"] * 7),
        ]
        text += "\n".join(head) + "\n" + integers({3: 3, 4: 3}, 7, 16, 5) + rows([0.0] * 100, 8, "%10.3f")
        for what, unit in (("accel", "cm/sec/sec"), ("veloc", "cm/sec"), ("displ", "cm")):
            text += f" {count} points of {what} data equally spaced at  .010 sec.  (units: {unit})\n"
            text += rows(WAVES[i][:count], 8, "%10.3f")
        text += f"/&  ----------  End of data for channel  {i + 1}  ----------\n"
    return text.replace("\n", end)


def csmip_v1():
    """Pairs of time and g/10, film steps, numbers that touch."""
    head = [
        "UNCORRECTED ACCELEROGRAM DATA   PROCESSED",
        "SMALL EARTHQUAKE",
        "date",
        "A   TRIGGER TIME: 1",
        "STATION NO. 1",
    ]
    head += ["A PLACE", "CHAN  1: N10E", "e", "h", "i", f"NO. OF POINTS = {COUNT}  RECORD LENGTH = 0.22 SEC"]
    head += ["UNITS OF UNCOR ACCEL ARE SEC AND G/10.  MAX = .150 G, AT 99.911 SEC.", "rms"]
    times = 99.9 + DT * np.arange(COUNT) + 0.001 * (np.arange(COUNT) % 3)
    pairs = np.column_stack([times, WAVES[0]]).ravel()
    return (
        "\n".join(head)
        + "\n"
        + integers({}, 7, 16, 5)
        + rows([0.0] * 50, 8, "%10.3f")
        + rows(pairs, 10, "%7.3f")
        + "/&\n"
    )


def cosmos(real62=10.0):
    reals = [-999.0] * 100
    reals[33], reals[61] = 0.005, real62  # the recorder's step is another one
    reals[62] = COUNT * real62 / 1000.0
    reals[63:65] = peak_of(WAVES[0])
    text = "Corrected acceleration  (Format v01.20 with 13 text lines)\nRecord of Small Earthquake\n" + "x\n" * 2
    text += "Statn No: 01-1 Code:CE-ABC  Net A Place\nCoords: 1 2\nRecorder: x\n"
    text += "Rcrd start time: 2019/05/05 06:47:39 (Q=5)\n"
    text += "Sta Chan   1: 340 deg (Rcrdr Chan  1) Location:\n" + "x\n" * 4
    text += " 100 Integer-header values follow on  10 lines, Format= (10I8)\n" + rows([1] + [-999] * 99, 10, "%8d")
    text += " 100 Real-header values follow on  20 lines, Format= (5F15.6)\n" + rows(reals, 5, "%15.6f")
    text += '  1 Comment line(s) follow, each starting with a "|":\n| nothing\n'
    text += f"   {COUNT} acceleration pts, approx  0 secs, units=cm/sec2(04),Format=(8F10.5)\n" + rows(
        WAVES[0], 8, "%10.5f"
    )
    return text + "End-of-data for channel\n"


def smc():
    ints = [-32768] * 48
    ints[12], ints[13], ints[15], ints[16] = 90, 65, 2, COUNT
    reals = [1.7e38] * 50
    reals[1] = 100.0
    reals[28], reals[29] = WAVES[0].argmax() * DT, WAVES[0].max()
    reals[30], reals[31] = WAVES[0].argmin() * DT, WAVES[0].min()
    text = "2 CORRECTED ACCELEROGRAM\n*\nABC\n 1989 10 18 0004 Small, CA\nMoment Mag= 7\n"
    text += "station = A Place  component=     65\n"
    text += "epicentral dist = 1\ninst type=SMA-1      data source = USGS\n*\n*\n*\n"
    text += rows(ints, 8, "%10d") + rows(reals, 5, "%15.7E") + "|\n|a comment\n"
    return text + "".join("".join(fortran(v) for v in WAVES[0][i : i + 8]) + "\n" for i in range(0, COUNT, 8))


def fortran(value):
    """Ten wide with a one-digit exponent, so that numbers touch: 1p, e10.4e1."""
    mantissa, exponent = f"{value:.4E}".split("E")
    return f"{mantissa:>7}E{int(exponent):+d}"


def geonet():
    text = ""
    for i, label in enumerate(("N10E", "N80W", "Up")):
        reals = [0.0] * 60
        reals[24], reals[25] = 0.005, DT
        ints = [0] * 40
        ints[26], ints[27], ints[33] = 10, (10, 280, 0)[i], COUNT
        peak, time = peak_of(WAVES[i])
        head = [
            "Uncorrected accelerogram 1_ABC_20 GNS Science",
            "Site ABC     42 31 24S  172 49 50E",
            "A Place",
            "Instrument",
        ]
        head += [
            "Resolution",
            "Accelerogram",
            "5 km off",
            "2016 November 13  11:02:56 UT",
            "Epicentre",
            f"Number of points {COUNT}    Duration {COUNT * DT:.2f} s",
        ]
        head += [
            "Raw readings in units of 2.00 mm/s/s  at intervals of 0.010 s",
            "Data is unfiltered",
            f"Component {label}",
        ]
        head += [
            f"Acceleration:  Peak  {2 * peak:.1f} mm/s/s at  {time:.2f} s     RMS   209.89 mm/s/s",
            "Velocity",
            "Displacement",
        ]
        text += "\n".join(head) + "\n" + rows(ints, 10, "%8d") + rows(reals, 10, "%8.3f") + rows(WAVES[i], 10, "%8.3f")
    return text


def usc():
    text = ""
    for code, wave in ((90, 0), (500, 2)):
        reals = [0.0] * 50
        reals[2], reals[4] = 0.22, 0.1
        head = [
            "VOLUME I   OF UNCORRECTED ACCELEROGRAM DATA OF A QUAKE",
            "SMALL EARTHQUAKE        10",
            *["x"] * 3,
            "A PLACE      7",
            *["x"] * 7,
        ]
        pairs = np.column_stack([DT * np.arange(COUNT) + 0.001 * (np.arange(COUNT) % 2), WAVES[wave]]).ravel()
        text += "\n".join(head) + "\n" + integers({8: 54, 26: code, 27: COUNT}, 7, 16, 5) + rows(reals, 8, "%10.3f")
        text += rows(pairs, 10, "%7.3f") + "------- END OF RECORD -------\n"
    return text


def peer_nga():
    text = "PEER NGA STRONG MOTION DATABASE RECORD\nSmall Quake-06, 10/15/1979, A Place, 230\n"
    text += f"ACCELERATION TIME SERIES IN UNITS OF G\nNPTS=   {COUNT}, DT=   .0100 SEC,\n"
    return text + rows(WAVES[0], 5, "%15.7E")


def peer_old():
    """Lower case, lines in another order, the count before its name."""
    text = "PACIFIC ENGINEERING AND ANALYSIS STRONG-MOTION DATA\n acceleration time history in units of g\n"
    text += f" SMALL QUAKE 10/15/79 2319, A PLACE, 230\n npts=  {COUNT}, dt= .01000 sec\n"
    return text + rows(WAVES[0], 5, "%15.7E")


def esm():
    head = [
        "EVENT_NAME: SMALL",
        "NETWORK: IT",
        "STATION_CODE: ABC",
        "STATION_NAME: Città",
        "SAMPLING_INTERVAL_S: 0.010000",
    ]
    head += [
        f"NDATA: {COUNT}",
        f"DURATION_S: {COUNT * DT:.3f}",
        f"PGA_CM/S^2: {peak_of(WAVES[0])[0]:.6f}",
        f"TIME_PGA_S: {peak_of(WAVES[0])[1]:.6f}",
        "STREAM: HNE",
        "UNITS: cm/s^2",
        "DATA_TYPE: ACCELERATION",
        "PROCESSING: manual",
        "DATA_LICENSE: CC BY 4.0",
    ]
    return "\n".join(head) + "\n" + rows(WAVES[0], 1, "%.6f")


def knet():
    fields = [("Origin Time", "2003/07/26"), ("Lat.", "38"), ("Long.", "141"), ("Depth. (km)", "12"), ("Mag.", "6.2")]
    fields += [("Station Code", "MYG007"), ("Station Lat.", "1"), ("Station Long.", "1"), ("Station Height(m)", "1")]
    fields += [
        ("Record Time", "2003/07/26 00:13:24"),
        ("Sampling Freq(Hz)", f"{COUNT}Hz"),
        ("Duration Time(s)", "1"),
        ("Dir.", "N-S"),
    ]
    fields += [
        ("Scale Factor", "2000(gal)/1000"),
        ("Max. Acc. (gal)", f"{np.abs(WAVES[0] - WAVES[0].mean()).max() * 2000:.3f}"),
        ("Last Correction", "x"),
        ("Memo.", ""),
    ]
    counts = np.round(WAVES[0] * 1000).astype(int) + 5000  # a zero level left in
    return "".join(f"{key:<18}{value}\n" for key, value in fields) + rows(counts, 8, "%9d")


def afad():
    head = [
        "STRONG GROUND MOTION RECORDS OF TURKIYE",
        "PLACE\t:\tA PLACE",
        "EARTHQUAKE DATE : 17/08/1999 00:01:39 (GMT)",
    ]
    head += [
        "STATION ID : 8101",
        "RECORD TIME : 17/08/1999",
        f"NUMBER OF DATA : {COUNT}",
        "SAMPLING INTERVAL (sec) : 0.01",
    ]
    head += [
        "RAW PGA VALUES (gal): "
        + " ".join(f"({name}) {np.abs(wave).max():.3f}" for name, wave in zip(("N-S", "E-W", "U-D"), WAVES)),
        "",
        "  N-S   E-W   U-D",
    ]
    return "\n".join(head) + "\n" + rows(np.column_stack(WAVES).ravel(), 3, "%12.3f")


def unam():
    head = ["RED", "x", "x", "x", "x", "x", "     ARCHIVO ESTANDAR DE ACELERACION", "CLAVE DE LA ESTACION  : ABCD"]
    head += [
        "ORIENTACION C1-C6 (rumbo;orientacion)   : /S00E;+L/+V/N90W;+T/",
        "INTERVALO DE MUESTREO, C1-C6 (s) : /.01/.01/.01/",
    ]
    head += [
        f"NUM. TOTAL DE MUESTRAS, C1-C6 : /{COUNT}/{COUNT}/{COUNT}/",
        "FECHA DEL SISMO [GMT] : 1985/09/19",
        "-----",
    ]
    head += ["   CANAL-1     CANAL-2     CANAL-3", "   S00E      V       N90W"]
    return "\n".join(head) + "\n" + rows(np.column_stack([WAVES[0], WAVES[2], WAVES[1]]).ravel(), 3, "%10.3f")


def renadic():
    text = ""
    for number, (label, wave) in enumerate((("NS", 0), ("EW", 1), ("Z", 2)), 1):
        values = WAVES[wave]
        peak = np.abs(values).argmax()
        head = [
            "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 05/28/2010",
            "SMALL 2010",
            "02/27/2010 3:35:20 (local)              (ORIGIN: 02/27/2010 6:35:20 GMT)",
            "                                   TRIGGER TIME: 2/27/2010 6:35:40.800 GMT",
            "STATION NO.          0.000N    0.000E  ETNA      S/N  121 (3  CHNS OF 3  AT STA)",
            "VIÑA DEL MAR   S/N 675",
            f"CHAN  {number}: {label}       (STA CHN:  {number})",
            "UNIVERSIDAD DE CHILE - RENADIC",
            "HYPOCENTER:   0.000N    0.000E  H=   0.0KM   MW= 8.8",
            "INSTR PERIOD = 0.0190 SEC,  DAMPING =0.6500,  SENSITIVITY =1.249 VDC/G",
            f"NO. OF POINTS =  {COUNT:5d}  RECORD LENGTH =  {COUNT * DT:6.3f} SEC",
            f"UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = {values[peak] / 10:6.3f} G, AT {peak * DT:7.3f} SEC",
            "RMS ACCEL OF COMPLETE RECORD = 0.041 G",
        ]
        pairs = np.column_stack([DT * np.arange(COUNT), values]).ravel()
        text += (
            "\n".join(head) + "\n" + integers({}, 7, 16, 5) + rows([0.0] * 50, 8, "%10.3f") + rows(pairs, 10, "%7.3f")
        )
        text += f"/&  ----------  END OF DATA FOR CHANNEL  {number}  ----------\n"
    return text


def bhrc():
    text = ""
    for number, (label, wave) in enumerate((("L", 0), ("V", 2), ("T", 1)), 1):
        head = [
            "* VOL1DS FILE:  3333/01",
            "Inst Type = SSA-2",
            "Origin Time : 2012/08/11   12:23:16",
            "",
            label,
            "",
            f"COMP {label}{number}",
            "A PLACE                   Station   37.485 N 45.891 E   Altitude 1333m   Azimuth L 352   T 82",
            "Epicenter 38.520 N 46.860 E   FD 12 Km mb      Ms      Mw6.1   M        ML   (BHRC   )",
            "INSTR PERIOD =  .019 SEC   DAMPING =  .640",
            f"NO. OF POINTS =  {COUNT:5d}      DURATION =  {COUNT * DT:6.3f}",
            "UNITS ARE SECONDS AND G/10",
            "",
        ]
        reals = [0.019, 0.64, COUNT * DT, 0.0, 0.1, 0.0, 1 / DT] + [0.0] * 33
        text += "\n".join(head) + "\n" + integers({27: COUNT}, 7, 16, 5) + rows(reals, 6, "%13.6E")
        text += rows(WAVES[wave], 10, "%13.5f") + "/&\n"
    return text


def itaca():
    """The first ITACA: values of width 14, five to a line, which touch; the last row is shorter."""
    peak = np.abs(WAVES[0]).argmax()
    head = [
        "Earthquake name : SMALL",
        "Station code : ABC",
        "Component : WE",
        "Sampling interval (s) : 0.010",
        f"Number of data : {COUNT}",
        f"Duration (s) : {COUNT * DT:.3f}",
        "Units : cm/s^2",
        f"PGA (cm/s^2) : {WAVES[0][peak]:.3f}",
        f"Time PGA (s) : {peak * DT:.3f}",
    ]
    return "\n".join(head) + "\n" + rows(WAVES[0], 5, "%14.7E")


def taiwan():
    """Times and three columns in the order that a comment names: up, north, east."""
    up, north, east = WAVES[2], WAVES[0], WAVES[1]
    head = [
        "#StationCode: ABC001",
        "#InstrumentKind: XYZ(1.CVA)",
        "#StartTime: 2017/03/07-22:11:14.000 ",
        f"#RecordLength(sec):   {COUNT * DT:.3f}",
        f"#SampleRate(Hz): {1 / DT:.0f}",
        "#AmplitudeUnit:  gal. DCoffset(corr)",
        *(
            f"#AmplitudeMAX. {name}: {wave.max():8.3f}~ {wave.min():8.3f}"
            for name, wave in zip("UNE", (up, north, east))
        ),
        "#DataSequence: Time U(+); N(+); E(+)",
        "#Data: 4F10.3 ",
    ]
    return "\n".join(head) + "\n" + rows(np.column_stack([DT * np.arange(COUNT), up, north, east]).ravel(), 4, "%10.3f")


# name: text, m/s² per number, label of the format, azimuths of x and y, whether there is a z
FORMATS = {
    "csmip_v2": (csmip_v2(), 0.01, "CSMIP V2", (90.0, 0.0), True),
    "csmip_v1": (csmip_v1(), g / 10, "CSMIP V1", (10.0,), False),
    "cosmos": (cosmos(), 0.01, "COSMOS 1.20", (340.0,), False),
    "smc": (smc(), 0.01, "USGS SMC V2", (65.0,), False),
    "geonet": (geonet(), 0.002, "GeoNet V1A", (10.0, 280.0), True),
    "usc": (usc(), g / 10, "USC V1", (90.0,), True),
    "peer_nga": (peer_nga(), g, "PEER AT2", (230.0,), False),
    "peer_old": (peer_old(), g, "PEER AT2", (230.0,), False),
    "esm": (esm(), 0.01, "ESM / ITACA ASCII (DYNA)", (90.0,), False),
    "afad": (afad(), 0.01, "AFAD text", (0.0, 90.0), True),
    "unam": (unam(), 0.01, "UNAM ASA", (180.0, 270.0), True),
    "renadic": (renadic(), g / 10, "RENADIC V1", (0.0, 90.0), True),
    "bhrc": (bhrc(), g / 10, "BHRC V1", (352.0, 82.0), True),
    "itaca": (itaca(), 0.01, "ESM / ITACA ASCII", (90.0,), False),
    "taiwan": (taiwan(), 0.01, "TSMIP text", (0.0, 90.0), True),
}
FILM = ("csmip_v1", "usc")
