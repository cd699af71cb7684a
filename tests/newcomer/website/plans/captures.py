"""The pages on captures, their export and their columns."""

from __future__ import annotations

from newcomer.website.planned import INSTALLED, Expected, NotRun, Plan, Program

# A recording, and a folder with two captures of raw bytes.
RECORDED = r"""
cobotwire call /dev/ttyACM0 get_angles --record arm.pcapng
mkdir captures
for name in left right; do
    for i in 1 2 3; do
        printf '\xFE\xFE\x0E\x20\x00\x8C\x00\x3D\xFF\xE6\xFF\x3F\x00\xAF\xFF\x51\xFA'
    done > captures/$name.bin
done
"""
STORE = "it reads an object store; tests/capture/archive runs such exports on an S3 server"
CLUSTER = (
    "cobotwire export s3://lab/raw/ -o s3://lab/lake/ --engine dask --scheduler tcp://head:8786"
)

CAPTURES = Plan(
    prepare=f"{RECORDED}\nfor i in left right killed; do cp arm.pcapng $i.pcapng; done",
    commands={
        "cobotwire capture info arm.pcapng": Expected(r"1 x get_angles\.reply"),
        # The recording is shorter than 12.5 s, so the part is empty.
        "cobotwire capture cut arm.pcapng -o part.pcapng --from 12.5 --to 60": (
            Expected("outside of the time range", code=1)
        ),
        "cobotwire capture cut arm.pcapng -o angles.pcapng --commands get_angles,send_angles": (
            Expected(r"wrote angles\.pcapng")
        ),
        "cobotwire capture merge left.pcapng right.pcapng -o both.pcapng": Expected("overlap"),
        "cobotwire capture repair killed.pcapng -o whole.pcapng": Expected("is a copy"),
    },
    programs={
        "from cobotwire import MyCobot280": Program(
            "import os; os.remove('arm.pcapng')", output=r"(.*get_angles|.* fe fe .*\n)+True None"
        ),
        'with Recording("arm.pcapng", codec, url="/dev/ttyACM0") as recording:': Program(
            "import os; os.remove('arm.pcapng')\n"
            "import cobotwire.codec\n"
            "from cobotwire.capture import Recording\n"
            "from cobotwire.editions.mycobot280 import TABLE\n"
            "from cobotwire.transport import TappedTransport, open_transport\n"
            "codec = cobotwire.codec.load(TABLE)",
        ),
        "from cobotwire.capture import read": Program(
            "import os; os.remove('arm.pcapng')\n"
            "transport.close()\n"
            "with MyCobot280('/dev/ttyACM0', record='arm.pcapng') as arm:\n"
            "    arm.power_on(); arm.send_angle(1, 5.0, 50); arm.get_angles()",
            r"request: 1 5\.0\n.*reply: Angles\(",
        ),
    },
)

EXPORT = Plan(
    prepare=f"{RECORDED}\npython -c 'import zstandard, pathlib; pathlib.Path("
    '"captures/arm1.pcapng.zst").write_bytes(zstandard.compress(pathlib.Path("arm.pcapng")'
    ".read_bytes()))'",
    commands={
        "pip install 'cobotwire[arrow]'": INSTALLED,
        "cobotwire export arm.pcapng -o out/": Expected(r"wrote out/get_angles\.reply\.parquet"),
        "cobotwire export captures/ -o angles.parquet --command get_angles --direction reply": (
            Expected(r"wrote angles\.parquet")
        ),
        "cobotwire export 'captures/*.pcapng.zst' -o lake/ --partition robot,command,day": (
            Expected(r"wrote lake/robot=arm1/")
        ),
        "cobotwire export s3://bucket/captures/ -o lake/ --from 2026-11-23 --to 2026-11-24": (
            NotRun(STORE)
        ),
        "cobotwire export arm.pcapng -o arm.mcap": Expected(r"wrote arm\.mcap"),
    },
    programs={
        'duckdb.read_parquet("lake/**/get_angles.reply.parquet", hive_partitioning=True)': Program(
            "import duckdb, polars"
        ),
        "from cobotwire.capture.export import ExportPlan, Inputs, write": Program(
            "import shutil; shutil.rmtree('out')", r"'get_angles\.reply': 7"
        ),
    },
)

ARCHIVES = Plan(
    prepare=RECORDED,
    unlike={CLUSTER: NotRun(STORE)},
    programs={
        "angles = scan.dataframe()  # robot, source, offset, time, j1 to j6": Program("import dask")
    },
)

COLUMNS = Plan(
    prepare=f"{RECORDED}\ncp captures/left.bin capture.bin",
    programs={
        "pyarrow.table(angles)": Program("import duckdb, pandas, polars, pyarrow"),
        'reader = native.column_reader("reply")': Program("use = print", r"Columns|cobotwire"),
    },
)

DIAGNOSER = 'diagnoser = Diagnoser(codec, "reply")  # the direction that the framer listens to'
DIAGNOSIS = Plan(
    programs={
        DIAGNOSER: Program(
            "import cobotwire.codec\n"
            "from cobotwire.diagnose import Diagnoser, Finding, summarize\n"
            "from cobotwire.editions.mycobot280 import TABLE\n"
            "codec = cobotwire.codec.load(TABLE)\n"
            "framer = codec.framer('reply')\n"
            "request = bytes.fromhex('FE FE 02 20 FA')\n"
            "data = request + bytes.fromhex('FF FF 01 04 02 38 02 BE')",
        )
    }
)

WIRESHARK = Plan(
    prepare="cobotwire call /dev/ttyACM0 get_angles --record arm.pcapng\n"
    "cobotwire-gen build spec/editions/mycobot280.yaml --out mycobot280"
    " --wireshark targets/wireshark",
    commands={
        "tshark -X lua_script:targets/wireshark/mycobot280.lua -r arm.pcapng": Expected(
            r"host → arm +mycobot280 5 > get_angles"
        )
    },
)
