"""Verification detects a report that was changed, or signed with another key."""

from __future__ import annotations

import contextlib
import json
import zipfile
from pathlib import Path

import pytest
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from cryptography.hazmat.primitives.asymmetric.rsa import generate_private_key
from cryptography.hazmat.primitives.serialization import (
    BestAvailableEncryption,
    Encoding,
    KeySerializationEncryption,
    NoEncryption,
    PrivateFormat,
    PublicFormat,
)
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import in_process
from cobotwire.cli.app import app
from cobotwire.conformance import Report
from cobotwire.conformance.reports import from_json, to_json
from cobotwire.conformance.survey import read_survey, survey_file
from cobotwire.inspect.seal import check_seal, digest_of, load_signer, sealed
from cobotwire.protocol.errors import UsageError

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=6,
)
PEM, OPENSSH = PrivateFormat.PKCS8, PrivateFormat.OpenSSH


def key_file(
    folder: Path,
    name: str = "key",
    format: PrivateFormat = PEM,
    lock: KeySerializationEncryption | None = None,
) -> Path:
    """Write a private key, and its public key beside it (``.pub``); return its path."""
    key, path = Ed25519PrivateKey.generate(), folder / name
    path.write_bytes(key.private_bytes(Encoding.PEM, format, lock or NoEncryption()))
    public = (Encoding.PEM, PublicFormat.SubjectPublicKeyInfo)
    if format is OPENSSH:
        public = (Encoding.OpenSSH, PublicFormat.OpenSSH)
    path.with_suffix(".pub").write_bytes(key.public_key().public_bytes(*public))
    return path


def verify(*words: object) -> tuple[int, str]:
    ended = in_process.run(app, "cobotwire", "conform", "verify", *map(str, words))
    return ended.returncode, ended.stdout + ended.stderr


@given(st.dictionaries(st.text(max_size=5), JSON, max_size=4), st.text(max_size=5), JSON)
def test_document_has_another_digest_if_and_only_if_its_contents_differ(
    document: dict[str, object], name: str, value: object
) -> None:
    whole = json.loads(json.dumps(sealed(document)))
    assert check_seal(whole).intact
    changed = {**whole, name: value}
    same = json.dumps({**document, name: value}, sort_keys=True) == json.dumps(
        document, sort_keys=True
    )
    assert check_seal(changed).intact is (same or (name == "signature" and value is None))


@pytest.mark.parametrize("format", [PEM, OPENSSH], ids=["pem", "openssh"])
def test_signed_report_is_verified_with_the_key_of_its_tester(
    format: PrivateFormat, tmp_path: Path
) -> None:
    key, other = key_file(tmp_path, "mine", format), key_file(tmp_path, "other", format)
    file = tmp_path / "report.json"
    text = to_json(Report("device", "mycobot", "arm"), load_signer(str(key)))
    file.write_text(text)
    assert verify(file)[0] == verify(file, "--key", key.with_suffix(".pub"))[0] == 0
    code, output = verify(file, "--key", other.with_suffix(".pub"))
    assert (code, "signed with another key" in output) == (1, True)
    # Someone who changes the contents can compute their digest, but not sign it.
    document = json.loads(text) | {"subject": "another arm"}
    file.write_text(json.dumps(document))
    assert "was changed" in verify(file)[1]
    document["digest"] = digest_of(document)
    file.write_text(json.dumps(document))
    assert verify(file) == (
        1,
        "The signature is wrong: it belongs to another report or to another key.\n",
    )


def test_report_without_a_seal_is_named(tmp_path: Path) -> None:
    file, key = tmp_path / "report.json", key_file(tmp_path)
    document = json.loads(to_json(Report("device", "mycobot", "arm")))
    file.write_text(json.dumps(document))
    assert verify(file)[0] == 0
    assert verify(file, "--key", key.with_suffix(".pub")) == (1, "The report is not signed.\n")
    del document["digest"]
    file.write_text(json.dumps(document))
    code, output = verify(file, "--json")
    assert (code, json.loads(output)["mistake"][:24]) == (1, "The report has no digest")
    assert from_json(file.read_text()).subject == "arm"
    file.write_text("[]")
    assert verify(file)[0] == 2


def test_changed_report_is_not_read() -> None:
    text = to_json(Report("device", "mycobot", "arm"))
    with pytest.raises(UsageError, match="was changed after it was written"):
        from_json(text.replace('"arm"', '"another"'))


def test_signed_survey_is_verified_and_changed_facts_or_recordings_are_detected(
    tmp_path: Path,
) -> None:
    key, file = key_file(tmp_path), tmp_path / "survey.zip"
    content = {"format": "cobotwire-survey", "version": 1, "facts": [], "robot": "mine"}
    file.write_bytes(survey_file(content, b"bytes", load_signer(str(key))))
    assert verify(file, "--key", key.with_suffix(".pub"))[0] == 0
    found, recording = read_survey(file)
    assert (found["robot"], recording) == ("mine", b"bytes")
    for changed, recorded in (({**found, "robot": "yours"}, recording), (found, b"others")):
        with zipfile.ZipFile(file, "w") as archive:
            archive.writestr("survey.json", json.dumps(changed))
            archive.writestr("recording.pcapng", recorded)
        assert "was changed" in verify(file)[1]
        with pytest.raises(UsageError, match="was changed after it was written"):
            read_survey(file)


def test_key_that_cannot_sign_is_named_before_the_run(tmp_path: Path) -> None:
    locked = key_file(tmp_path, "locked", lock=BestAvailableEncryption(b"x"))
    rsa = tmp_path / "rsa"
    rsa.write_bytes(
        generate_private_key(65537, 1024).private_bytes(Encoding.PEM, PEM, NoEncryption())
    )
    for path, message in (
        (locked, "is not an Ed25519 private key in PEM or OpenSSH format"),
        (rsa, "it is a key of another kind"),
        (tmp_path / "none", "none: No such file"),
    ):
        words = ("conform", "device", "/dev/no-port", "--json", "--sign", str(path))
        ended = in_process.run(app, "cobotwire", *words)
        assert ended.returncode == 2
        assert message in ended.stderr


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.binary(max_size=80), st.sampled_from([b"", b"-----BEGIN OPENSSH PRIVATE KEY-----\n"]))
def test_any_bytes_are_a_key_or_an_error(tmp_path: Path, data: bytes, head: bytes) -> None:
    path = tmp_path / "key"
    path.write_bytes(head + data)
    with contextlib.suppress(UsageError):
        load_signer(str(path))


@given(JSON)
def test_any_signature_is_right_or_wrong(value: object) -> None:
    document = sealed({"format": "x"}) | {"signature": value}
    parts = {"public_key": value, "value": value, "algorithm": "ed25519"}
    assert check_seal(document).signature == ("none" if value is None else "wrong")
    assert check_seal({**document, "signature": parts}).signature == "wrong"
    zeros = {**parts, "public_key": "00" * 32, "value": "00" * 64}
    assert not check_seal({**document, "signature": zeros}).intact
