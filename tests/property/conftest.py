"""Reports of the property tests."""


def pytest_terminal_summary(terminalreporter):
    """Say how many forms of fields were tried; works with several processes too."""
    reports = terminalreporter.stats.get("passed", [])
    tried = sum(n for report in reports for key, n in report.user_properties if key == "forms")
    if tried:
        terminalreporter.write_line(f"forms tried: {tried}")
