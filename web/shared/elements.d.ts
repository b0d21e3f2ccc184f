// The elements of the pages, for the type check: `querySelector("pair-view")` is a `PairView`.

declare global {
  interface HTMLElementTagNameMap {
    "export-panel": import("../projects/export_panel.js").ExportPanel;
    "class-corrections": import("../shared/class_corrections.js").ClassCorrections;
    "folder-browser": import("../projects/folder_browser.js").FolderBrowser;
    "job-log": import("../projects/project_tools.js").JobLog;
    "job-status": import("../projects/job_status.js").JobStatus;
    "job-workers": import("../projects/job_workers.js").JobWorkersPart;
    "map-verdict": import("../shared/map_verdict.js").MapVerdict;
    "new-job": import("../projects/new_job.js").NewJob;
    "page-head": import("../shared/page_head.js").PageHead;
    "pair-view": import("../review/view.js").PairView;
    "project-storage": import("../projects/project_storage.js").ProjectStoragePanel;
    "project-tools": import("../projects/project_tools.js").ProjectTools;
    "recording-look": import("../projects/recording_summary.js").RecordingLook;
    "review-queue": import("../review/queue.js").ReviewQueue;
    "rig-form": import("../rigs/rig_form.js").RigForm;
    "rig-section": import("../projects/rig_section.js").RigSection;
    "rig-view": import("../rigs/rig_view.js").RigView;
    "session-list": import("../account/session_list.js").SessionList;
    "setting-editor": import("../projects/setting_editor.js").SettingEditor;
    "slice-above": import("../slices/above.js").SliceAbove;
    "slice-view": import("../slices/view.js").SliceView;
    "upload-box": import("../projects/upload_box.js").UploadBox;
  }
  interface Navigator {
    /** Not in every browser. */
    getBattery?: () => Promise<any>;
  }
}

export {};
