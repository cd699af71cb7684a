"""The codecs that come with cobotwire, as programs that a run can test.

python -m cobotwire.conformance.codec.adapter native|reference|pymycobot
"""
